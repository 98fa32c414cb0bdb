#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <thread>

#include "../environment.hpp"
#include "child_run.hpp"
#include "nets.hpp"
#include "run/execute.hpp"
#include "system/console.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// Standard error as a pipe while it lives.
class ErrorPipe {
 public:
  ErrorPipe() {
    EXPECT_EQ(pipe(ends_.data()), 0);
    before_ = dup(STDERR_FILENO);
    dup2(ends_[1], STDERR_FILENO);
  }
  ErrorPipe(const ErrorPipe&) = delete;
  ErrorPipe& operator=(const ErrorPipe&) = delete;
  ~ErrorPipe() {
    dup2(before_, STDERR_FILENO);
    for (const int descriptor : {before_, ends_[0], ends_[1]}) close(descriptor);
  }
  /// Reads until that was printed.
  void await(std::string_view text) {
    std::array<char, 256> piece;
    while (seen_.find(text) == std::string::npos)
      if (const ssize_t count = read(ends_[0], piece.data(), piece.size()); count > 0)
        seen_.append(piece.data(), static_cast<std::size_t>(count));
  }

 private:
  std::array<int, 2> ends_{};
  int before_ = -1;
  std::string seen_;
};

TEST(Stop, SaysWhichSubsystemItWaitsForAndInWhichBehaviour) {
  TestSystem system;
  ErrorPipe errors;
  Script slow, stops;
  slow.call = [&](ScriptState& state) {
    if (state.context.iteration == 1) errors.await("waits for robot.slow in run (");
  };
  stops.call = [](ScriptState& state) {
    if (state.context.iteration == 5) state.context.stop("enough");
  };
  system.add("robot.slow", nets::alone, slow, 1ms);
  system.add("robot.b", nets::alone, stops, 1ms);
  EXPECT_EQ(run(system, steady(60s)).ended, "stopped: enough");
}

TEST(Stop, GivesTheSafeCommandWhileUserCodeHasNotReturned) {
  TestSystem system;
  std::atomic<bool> stopping{false}, safe{false};
  Script motor, stops;
  motor.acts = true;
  motor.call = [&](ScriptState& state) {
    state.command = 5;
    if (state.context.iteration < 1) return;
    stopping = true;
    while (!safe) std::this_thread::yield();
  };
  stops.call = [&](ScriptState& state) {
    if (stopping) state.context.stop("enough");
  };
  system.devices.accept = [&](double value) {
    if (value < 0) safe = true;
    return true;
  };
  system.add("robot.motor", nets::alone, motor, 1ms, 0ms, Kind::effector);
  system.add("robot.b", nets::alone, stops, 1ms);
  EXPECT_EQ(run(system, steady(60s)).ended, "stopped: enough");
  EXPECT_EQ(system.devices.commands, (std::vector<double>{5, -1, -1, -1}))
      << "5 was not given after the stop";
}

/// Runs it in a process of its own, which gives up after so long: exit code 1, and why the run ended.
[[nodiscard]] std::pair<int, std::string> give_up(TestSystem& system, const RunOptions& options,
                                                  Duration unsafe, Duration safe) {
  const std::string file = scratch_file("ended");
  ChildRun child([&](CommandLog&) {
    const auto end_process = [&](const RunSummary& summary) {
      std::ofstream(file) << summary.ended << std::flush;
      _exit(summary.failed ? 1 : 2);
    };
    std::string error;
    const GiveUp give_up{.end_process = end_process, .unsafe = unsafe, .safe = safe};
    return execute(system.system(), options, nullptr, give_up, error) ? 3 : 4;
  });
  const int code = child.wait();
  return {code, file_bytes(file)};
}

/// The devices of the others are safe and closed, and the recording has its end.
TEST(Stop, GivesUpAFunctionThatNeverReturns) {
  TestSystem system;
  Script hangs, stops;
  hangs.call = [](ScriptState& state) {
    while (state.context.iteration > 1) std::this_thread::sleep_for(1s);
  };
  stops.acts = true;
  stops.call = [](ScriptState& state) {
    if (state.context.iteration == 20) state.context.stop("enough");
  };
  system.add("robot.hangs", nets::alone, hangs, 1ms);
  system.add("robot.b", nets::alone, stops, 1ms, 0ms, Kind::effector);
  RunOptions options = steady(60s);
  options.recording = scratch_file("run");
  const auto [code, ended] = give_up(system, options, 1h, 100ms);
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(ended.starts_with("stopped: enough; robot.hangs has not returned from run 0.")) << ended;
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_FALSE(recording->truncated);
}

TEST(Stop, GivesUpADriverThatNeverReturnsAndNamesItsDevice) {
  TestSystem system;
  Script motor;
  motor.acts = true;
  motor.call = [](ScriptState& state) { state.command = 5; };
  system.devices.accept = [](double value) {
    while (value == -1) std::this_thread::sleep_for(1s);
    return true;
  };
  system.add("robot.motor", nets::alone, motor, 1ms, 0ms, Kind::effector);
  const auto [code, ended] = give_up(system, steady(500ms), 100ms, 1h);
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(ended.starts_with("duration; robot.motor has not returned from run 0.")) << ended;
  EXPECT_TRUE(ended.ends_with("s after the stop; robot.motor.command has not taken its safe command"))
      << ended;
}

TEST(Stop, GivesUpAReceptorThatIsNeverReadAndNamesIt) {
  TestSystem system;
  Script sonar;
  sonar.senses = true;
  system.devices.sense = [](double&) -> bool {
    for (;;) std::this_thread::sleep_for(1s);
  };
  system.add("robot.sonar", nets::alone, sonar, 1ms, 0ms, Kind::receptor);
  const auto [code, ended] = give_up(system, steady(500ms), 1h, 100ms);
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(ended.starts_with("duration; read() of robot.sonar.sensed has not returned ")) << ended;
}

/// Its own thread is in the driver, and cannot report that.
TEST(Stop, ComesIfADeviceDoesNotObeyAnEmergencyStop) {
  TestSystem system;
  Script motor, stops;
  motor.acts = true;
  motor.call = [](ScriptState& state) { state.command = 5; };
  stops.call = [](ScriptState& state) {
    if (state.context.iteration == 20) state.context.emergency_stop("smoke");
  };
  system.devices.accept = [](double value) {
    while (value == -1) std::this_thread::sleep_for(1s);
    return true;
  };
  system.add("robot.motor", nets::alone, motor, 1ms, 0ms, Kind::effector);
  system.add("robot.b", nets::alone, stops, 1ms);
  const auto [code, ended] = give_up(system, steady(10min), 100ms, 1h);
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(ended.starts_with("stopped: robot.motor.command has not taken its safe command; ")) << ended;
}

TEST(Watchdog, GivesTheSafeCommandWhileUserCodeHasNotReturned) {
  TestSystem system;
  std::atomic<bool> safe{false};
  Script motor;
  motor.acts = true;
  motor.call = [&](ScriptState& state) {
    state.command = 5;
    if (state.context.iteration == 1)
      while (!safe) std::this_thread::yield();
    if (state.context.iteration == 3) state.context.stop("enough");
  };
  motor.route = [](const ScriptState&, bool) { return 0; };
  system.devices.accept = [&](double value) {
    if (value < 0) safe = true;
    return true;
  };
  Policies policies;
  policies.watchdog = 50ms;
  system.add("robot.motor", nets::two_behaviours, motor, 5ms, 0ms, Kind::effector, policies);
  RunOptions options = steady(60s);
  options.recording = scratch_file("run");
  const RunSummary summary = run(system, options);
  EXPECT_EQ(summary.ended, "stopped: enough");
  EXPECT_GE(summary.subsystems.at(0).errors, 1U);
  std::string error;
  const auto recording = read_recording(options.recording, error);
  ASSERT_TRUE(recording) << error;
  bool told = false;
  for (const auto& [event, text] : recording->entries)
    told = told || text.find("robot.motor.first.in: has not returned for 0.05 s") != std::string::npos;
  EXPECT_TRUE(told);
}

TEST(RealTime, ThatIsNotPermittedIsWarnedOfOnce) {
  TestSystem system;
  Policies policies;
  policies.realtime.cpu = 1023;  // there is none such
  Script stops;
  stops.call = [](ScriptState& state) {
    if (state.context.iteration == 5) state.context.stop("enough");
  };
  system.add("robot.a", nets::alone, stops, 1ms, 0ms, Kind::control, policies);
  system.add("robot.b", nets::alone, {}, 1ms, 0ms, Kind::control, policies);
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run(system, steady(60s)).ended, "stopped: enough");
  const std::string said = ::testing::internal::GetCapturedStderr();
  const std::size_t first = said.find("not in real time, as the specification asks (");
  ASSERT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.find("not in real time", first + 1), std::string::npos) << said;
}

/// So many stops; TESSERA_STOPS=10000 for the long form.
[[nodiscard]] std::uint64_t stops() { return from_environment("TESSERA_STOPS", share_of(500)); }

TEST(Stop, AtARandomMomentNeverHangs) {
  std::mt19937_64 random(1);
  const auto below = [&](std::uint64_t limit) { return random() % limit; };
  console::silence(true);
  for (std::uint64_t round = 0; round < stops(); ++round) {
    TestSystem system;
    Script stopper, thrower, motor;
    const std::uint64_t at = below(40), fails_at = below(80);
    stopper.call = [=](ScriptState& state) {
      if (state.context.iteration == at) state.context.stop("enough");
    };
    thrower.call = [=](ScriptState& state) {
      if (state.context.iteration == fails_at) throw std::runtime_error("oops");
    };
    motor.acts = true;
    const auto a = system.add("robot.a", nets::b_sender, stopper, 100us);
    const auto b = system.add("robot.b", nets::b_receiver_ack, motor, 0ms, 1ms, Kind::effector);
    const auto c = system.add("robot.c", nets::nb_sender_persistent, thrower, 50us);
    const auto d = system.add("robot.d", nets::b_receiver_timed, motor, 0ms, 1ms, Kind::effector);
    system.connect(a, "x", b, "x", acknowledged);
    system.connect(c, "x", d, "x", buffered, 0ms, 1ms);
    RunOptions options = steady(Duration(static_cast<Duration::rep>(below(3'000'000))));
    EXPECT_GT(run(system, options).firings, 0U);
    ASSERT_FALSE(system.devices.commands.empty());
    EXPECT_EQ(system.devices.commands.back(), -1);
  }
  console::silence(false);
}

TEST(Recording, OfASlowWriterLosesEventsAndDoesNotHoldUpTheRun) {
  TestSystem system;
  const std::string file = scratch_file("fifo");
  std::filesystem::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  std::atomic<bool> far{false};
  // Opens it, and reads no byte before the run has gone far.
  std::string read_at_last;
  std::thread reader([&] {
    std::ifstream stream(file, std::ios::binary);
    far.wait(false);
    read_at_last = {std::istreambuf_iterator<char>(stream), {}};
  });
  Script talks;
  talks.call = [&](ScriptState& state) {
    const std::string line(500, 'x');
    for (int count = 0; count < 100; ++count) state.context.log("{}", line);
    if (state.context.iteration < 300) return;
    far = true;
    far.notify_one();
    state.context.stop("enough");
  };
  system.add("robot.a", nets::alone, talks, 1ms);
  RunOptions options = steady(60s);
  options.recording = file;
  console::silence(true);
  const RunSummary summary = run(system, options);
  console::silence(false);
  reader.join();
  EXPECT_EQ(summary.ended, "stopped: enough");
  EXPECT_GT(summary.lost_events, 1000U);
  const std::string copy = scratch_file("copy");
  std::ofstream(copy, std::ios::binary) << read_at_last;
  std::string error;
  const auto recording = read_recording(copy, error);
  ASSERT_TRUE(recording) << error;
  EXPECT_FALSE(recording->truncated);
  EXPECT_GT(recording->entries.size(), 1U);
}

}  // namespace
}  // namespace tessera::testing
