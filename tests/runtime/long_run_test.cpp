#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "../environment.hpp"
#include "nets.hpp"
#include "system/console.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;
namespace fs = std::filesystem;

namespace tessera::testing {
namespace {

/// Simulated minutes; TESSERA_LONG_RUN_MINUTES=1440 for the long form.
[[nodiscard]] std::chrono::minutes minutes() {
  return std::chrono::minutes(from_environment("TESSERA_LONG_RUN_MINUTES", 20));
}

[[nodiscard]] std::size_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(LongRun, KeepsItsGridItsMemoryAndTheLimitOfItsRecording) {
  constexpr std::uint64_t limit = 4'000'000;
  constexpr std::uint32_t segments = 4;
  const Duration length = minutes(), early = length / 24;
  TestSystem system;
  std::size_t resident_early = 0, resident_late = 0;
  std::uint64_t off_grid = 0, calls = 0;
  Script sensor, control, motor;
  sensor.senses = true;
  system.devices.sense = [](double& value) {
    value += 0.001;
    return true;
  };
  sensor.call = [](ScriptState& state) { state.out_x = state.sensed.value(); };
  control.call = [&](ScriptState& state) {
    // The k-th release is exactly k periods after the start.
    if (state.context.now.time_since_epoch() != state.context.iteration * 50ms) ++off_grid;
    state.out_x = state.x.value() * 2;
    ++calls;
    const Duration now = state.context.now.time_since_epoch();
    if (resident_early == 0 && now >= early) resident_early = resident_bytes();
    if (now >= length - 1s) resident_late = resident_bytes();
  };
  control.decide = [](const ScriptState& state) {
    return state.behaviour == 0 ? Outcome::terminal : Outcome::go_on;
  };
  motor.call = [](ScriptState& state) { state.out_x = state.x.value(); };
  const auto c = system.add("robot.control", nets::paper_control, control, 50ms);
  const auto s = system.add("robot.sensor", nets::paper_sensor, sensor, 20ms, 0ms, Kind::receptor);
  const auto m = system.add("robot.motor", nets::paper_motor, motor, 20ms);
  system.connect(s, "line", c, "line", asynchronous);
  system.connect(c, "motion", m, "velocity", buffered, 0ms, 200ms);
  RunOptions options = simulated(length);
  options.recording = scratch_file("run.tsr");
  options.record_limit = {limit / segments, segments};
  const RunSummary summary = run(system, options);
  std::size_t recorded = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(options.recording).parent_path()))
    recorded += entry.file_size();

  std::printf(
      "%.0f min simulated in %.1f s: %llu firings, %llu calls of the control; resident %.2f MB at %.0f min, "
      "%.2f MB at the end; recording %.2f MB\n",
      seconds(length) / 60, summary.wall_s, static_cast<unsigned long long>(summary.firings),
      static_cast<unsigned long long>(calls), static_cast<double>(resident_early) * 1e-6, seconds(early) / 60,
      static_cast<double>(resident_late) * 1e-6, static_cast<double>(recorded) * 1e-6);
  EXPECT_EQ(summary.ended, "duration");
  EXPECT_EQ(off_grid, 0U);
  EXPECT_EQ(calls, static_cast<std::uint64_t>(length / 50ms));
  EXPECT_LE(resident_late, resident_early + 1'000'000);
  EXPECT_LE(recorded, limit);
  EXPECT_GE(recorded, limit / 2);
  fs::remove_all(fs::path(options.recording).parent_path());
}

}  // namespace
}  // namespace tessera::testing
