#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string>
#include <thread>

#include "nets.hpp"
#include "system/stop_signals.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// Runs a system whose function does not return from its third call on, and sends itself a signal then.
[[noreturn]] void run_for_ever(const std::string& recording, bool logs) {
  static std::atomic<bool> entered{false};
  TestSystem system;
  Script script;
  script.call = [logs](ScriptState& state) {
    for (volatile bool for_ever = state.context.iteration == 2; for_ever;) {
      entered = true;
      if (!logs) continue;
      state.context.log("still here");
      std::this_thread::sleep_for(1ms);  // so that the terminal takes the lines of the others, too
    }
  };
  system.add("robot.a", nets::alone, script, 10ms);
  std::thread([] {
    while (!entered) std::this_thread::sleep_for(1ms);
    // ThreadSanitizer loses a signal that the kernel gives to a thread which has only just been created.
    for (; StopSignals::pending() == 0; std::this_thread::sleep_for(10ms)) kill(getpid(), SIGTERM);
  }).detach();
  RunOptions options = simulated(1h);
  options.recording = recording;
  static_cast<void>(run(system, options));
  _exit(0);
}

TEST(CallWatch, ASignalEndsARunWhoseFunctionDoesNotReturn) {
  for (const bool logs : {false, true}) {
    const std::string file = scratch_file("for_ever.tessrec");
    // The end names the function, also where a loaded machine had no time for the warning before it.
    EXPECT_EXIT(run_for_ever(file, logs), ::testing::ExitedWithCode(128 + SIGTERM),
                "ended by SIGTERM; robot.a.run has not returned for ");
    std::string error;
    const std::optional<Recording> recording = read_recording(file, error);
    ASSERT_TRUE(recording) << error;
    std::uint64_t calls = 0;
    for (const Recording::Entry& entry : recording->entries)
      if (entry.event.kind() == Event::Kind::call) ++calls;
    EXPECT_EQ(calls, 3U);
    EXPECT_EQ(recording->entries.back().event.kind(), Event::Kind::stop);
    EXPECT_TRUE(recording->entries.back().text.starts_with("SIGTERM; robot.a.run has not returned for "));
  }
}

TEST(CallWatch, AFunctionThatTakesLongIsNamedAndTheRunGoesOn) {
  TestSystem system;
  Script script;
  script.call = [](ScriptState& state) {
    if (state.context.iteration == 1) std::this_thread::sleep_for(4s);
  };
  system.add("robot.a", nets::alone, script, 10ms);
  ::testing::internal::CaptureStderr();
  const RunSummary summary = run(system, simulated(50ms));
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(summary.ended, "duration");
  EXPECT_FALSE(summary.failed);
  EXPECT_NE(said.find("robot.a.run has not returned for "), std::string::npos) << said;
}

}  // namespace
}  // namespace tessera::testing
