#include "tessera/signals.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <fstream>
#include <thread>

#include "child_run.hpp"
#include "nets.hpp"
#include "system/stop_signals.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// sensor -> motor on the steady clock, which commands 5 and whose safe command is -1, until a signal ends
/// it. Returns the exit code that a controller would have.
[[nodiscard]] int drive_until_stopped(CommandLog& log, const RunOptions& options = steady(1h),
                                      const Script& control = {}) {
  TestSystem system;
  Script motor;
  motor.acts = true;
  motor.call = [](ScriptState& state) { state.command = 5; };
  system.devices.accept = [&log](double value) {
    log.note(value, -1);
    return true;
  };
  const auto a = system.add("robot.control", nets::nb_sender, control, 1ms);
  const auto b = system.add("robot.motor", nets::b_receiver, motor, 0ms, 1min, Kind::effector);
  system.connect(a, "x", b, "x", buffered);
  std::string error;
  const std::optional<RunSummary> summary = execute(system.system(), options, error);
  if (!summary || summary->failed) return 1;
  return summary->signal != 0 && summary->ended == signal_name(summary->signal) ? 128 + summary->signal : 0;
}

[[nodiscard]] double milliseconds_since(std::int64_t since_ns, std::int64_t until_ns) {
  return static_cast<double>(until_ns - since_ns) * 1e-6;
}

TEST(Signals, ThatEndAProcessEndTheRunSafelyAndWithTheirExitCode) {
  double slowest_ms = 0;
  for_handled_signals([&](int signal, SignalUse use) {
    if (use != SignalUse::stop || (signal > SIGRTMIN && signal < SIGRTMAX)) return;
    SCOPED_TRACE(signal_name(signal));
    ChildRun child([](CommandLog& log) { return drive_until_stopped(log); });
    ASSERT_TRUE(child.await_commands(5));
    const std::int64_t sent_ns = std::chrono::steady_clock::now().time_since_epoch().count();
    child.kill(signal);
    EXPECT_EQ(child.wait(), 128 + signal);
    EXPECT_EQ(child.log().last, -1);
    slowest_ms = std::max(slowest_ms, milliseconds_since(sent_ns, child.log().last_ns));
  });
  RecordProperty("slowest_ms", std::to_string(slowest_ms));
}

TEST(Signals, ThatOnlyTellOfFailedWritingChangeNothing) {
  ChildRun child([](CommandLog& log) { return drive_until_stopped(log); });
  ASSERT_TRUE(child.await_commands(5));
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGTTIN, SIGTTOU, SIGCHLD, SIGURG, SIGWINCH, SIGCONT}) {
    child.kill(signal);
    ASSERT_TRUE(child.await_commands(5)) << signal_name(signal);
  }
  child.kill(SIGTERM);
  EXPECT_EQ(child.wait(), 128 + SIGTERM);
}

TEST(Signals, ThatSomebodyIgnoresOrHandlesAreLeftToThem) {
  ChildRun child([](CommandLog& log) {
    signal(SIGHUP, SIG_IGN);  // nohup
    signal(SIGUSR1, [](int) {});
    return drive_until_stopped(log);
  });
  ASSERT_TRUE(child.await_commands(5));
  for (const int signal : {SIGHUP, SIGUSR1}) {
    child.kill(signal);
    ASSERT_TRUE(child.await_commands(5));
  }
  child.kill(SIGINT);
  EXPECT_EQ(child.wait(), 128 + SIGINT);
}

TEST(Signals, AHandlerThatIsLateWritesIntoNoFileOfSomebodyElse) {
  int before = -1;
  {
    const StopSignals signals;
    before = StopSignals::descriptor();
    ASSERT_GE(before, 0);
  }
  // A handler that another thread began before the end of the object writes now.
  const int opened = open("/dev/null", O_WRONLY | O_CLOEXEC);
  EXPECT_NE(opened, before);
  close(opened);
  const std::uint64_t late = 1;
  ASSERT_EQ(write(before, &late, sizeof late), ssize_t{sizeof late});
  const StopSignals next;
  pollfd news{.fd = StopSignals::descriptor(), .events = POLLIN, .revents = 0};
  EXPECT_EQ(poll(&news, 1, 0), 0) << "a signal of the run before";
}

/// Both threads handle a signal at the same time, many times over.
[[noreturn]] void get_two_signals_at_once() {
  constexpr int rounds = 500;
  std::atomic<int> arrived{0};
  // Wakes nobody up, so that both go on within nanoseconds if both have a processor.
  const auto meet = [&arrived](int meeting) {
    ++arrived;
    while (arrived < 2 * meeting) std::this_thread::yield();
  };
  const auto signal_oneself = [&meet](int round) {
    meet(2 * round + 1);
    raise(SIGTERM);
    meet(2 * round + 2);
  };
  std::thread other([&] {
    for (int round = 0; round < rounds; ++round) signal_oneself(round);
  });
  for (int round = 0; round < rounds; ++round) {
    const StopSignals signals;
    signal_oneself(round);
    if (StopSignals::pending() != SIGTERM) _exit(1);
  }
  other.join();
  _exit(0);
}

TEST(Signals, TwoThatComeAtOnceAreOneRequestToStop) {
  EXPECT_EXIT(get_two_signals_at_once(), ::testing::ExitedWithCode(0), "");
}

TEST(Signals, SuspensionMakesSafeFirstAndTheRunGoesOnWithNewValues) {
  const std::string recording = scratch_file("run");
  RunOptions options = steady(1h);
  options.recording = recording;
  ChildRun child([&](CommandLog& log) { return drive_until_stopped(log, options); });
  ASSERT_TRUE(child.await_commands(5));
  for (int round = 0; round < 3; ++round) {
    child.kill(SIGTSTP);
    ASSERT_EQ(child.wait(), 2000 + SIGSTOP);
    EXPECT_EQ(child.log().last, -1);
    const std::uint64_t commands = child.log().commands;
    child.kill(SIGCONT);
    ASSERT_TRUE(child.await([&] { return child.log().commands > commands + 5; }));
  }
  child.kill(SIGTERM);
  EXPECT_EQ(child.wait(), 128 + SIGTERM);
  EXPECT_EQ(child.log().last, -1);
  std::string error;
  const auto read = read_recording(recording, error);
  ASSERT_TRUE(read) << error;
  int suspended = 0, again = 0;
  std::string told;
  for (const auto& [event, text] : read->entries) {
    if (text.starts_with("robot.motor")) told += fmt::format("{} ns: {}\n", event.time_ns, text);
    suspended += text == "robot.motor.command: safe command: the run is suspended" ? 1 : 0;
    again += text == "robot.motor.command: commands go to it again" ? 1 : 0;
  }
  EXPECT_EQ(suspended, 3) << told;
  EXPECT_EQ(again, 4) << "the first after the first value\n" << told;
}

TEST(Signals, SuspendedTimeIsNoTimeOfTheRun) {
  const std::string recording = scratch_file("run");
  RunOptions options = steady(1h);
  options.recording = recording;
  ChildRun child([&](CommandLog& log) { return drive_until_stopped(log, options); });
  ASSERT_TRUE(child.await_commands(5));
  const auto begin = std::chrono::steady_clock::now();
  child.kill(SIGTSTP);
  ASSERT_EQ(child.wait(), 2000 + SIGSTOP);
  const auto must_not_count = 1s;
  std::this_thread::sleep_for(must_not_count);
  child.kill(SIGCONT);
  ASSERT_TRUE(child.await_commands(5));
  const auto at_most = std::chrono::steady_clock::now() - begin - must_not_count;
  child.kill(SIGTERM);
  EXPECT_EQ(child.wait(), 128 + SIGTERM);
  std::string error;
  const auto read = read_recording(recording, error);
  ASSERT_TRUE(read) << error;
  std::int64_t suspended_ns = -1, resumed_ns = -1;
  for (const auto& [event, text] : read->entries) {
    if (event.kind() == Event::Kind::log && text.starts_with("suspended")) suspended_ns = event.time_ns;
    if (event.kind() == Event::Kind::log && text.starts_with("goes on")) resumed_ns = event.time_ns;
  }
  ASSERT_GE(suspended_ns, 0);
  EXPECT_LE(std::chrono::nanoseconds(resumed_ns - suspended_ns), at_most);
}

TEST(Signals, BeforeTheFirstFiringCommandNothing) {
  ChildRun child([](CommandLog& log) {
    TestSystem system;
    Script motor;
    motor.acts = true;
    motor.call = [](ScriptState& state) { state.command = 5; };
    system.devices.accept = [&log](double value) {
      log.note(value, -1);
      return true;
    };
    system.devices.made = [] { raise(SIGTERM); };  // as if it came while drivers are made
    system.add("robot.motor", nets::alone, motor, 1ms, 0ms, Kind::effector);
    std::string error;
    const std::optional<RunSummary> summary = execute(system.system(), steady(1h), error);
    return summary ? 128 + summary->signal : 1;
  });
  const int code = child.wait();
  EXPECT_TRUE(code == 128 + SIGTERM || code == 1) << code;
  EXPECT_EQ(child.log().commands, 0U);
}

TEST(Signals, AFileThatMayNotGrowEndsTheRecordingAndNotTheRun) {
  const std::string recording = scratch_file("run");
  ChildRun child([&](CommandLog& log) {
    const rlimit limit{.rlim_cur = 4096, .rlim_max = RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &limit);
    RunOptions options = steady(1h);
    options.recording = recording;
    return drive_until_stopped(log, options);
  });
  ASSERT_TRUE(child.await_commands(500));
  child.kill(SIGTERM);
  EXPECT_EQ(child.wait(), 128 + SIGTERM);
  EXPECT_EQ(child.log().last, -1);
  std::string error;
  EXPECT_TRUE(read_recording(recording, error)) << error;
}

/// A function that does not let go of the only processor, in real time, for at most 0.9 s.
[[nodiscard]] int hog_the_processor(CommandLog& log) {
  cpu_set_t first;
  CPU_ZERO(&first);
  CPU_SET(0, &first);
  sched_setaffinity(0, sizeof first, &first);
  TestSystem system;
  std::atomic<bool> safe{false}, in_time{false};
  Script motor;
  motor.acts = true;
  motor.call = [&](ScriptState& state) {
    state.command = 5;
    if (state.context.iteration < 3) return;
    const auto until = std::chrono::steady_clock::now() + 900ms;
    while (!safe && std::chrono::steady_clock::now() < until) continue;
    in_time = safe.load();
    state.context.stop("enough");
  };
  system.devices.accept = [&](double value) {
    log.note(value, -1);
    if (value == -1) safe = true;
    return true;
  };
  Policies policies;
  policies.watchdog = 20ms;
  policies.realtime = {.policy = RealTime::Policy::fifo, .priority = 50};
  system.add("robot.motor", nets::alone, motor, 1ms, 0ms, Kind::effector, policies);
  std::string error;
  static_cast<void>(execute(system.system(), steady(1min), error));
  return in_time ? 0 : 1;
}

TEST(RealTime, ASubsystemThatDoesNotLetGoOfItsProcessorIsMadeSafe) {
  sched_param parameters{};
  parameters.sched_priority = 51;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) GTEST_SKIP() << "no permission for real time";
  parameters.sched_priority = 0;
  ASSERT_EQ(sched_setscheduler(0, SCHED_OTHER, &parameters), 0);
  ChildRun child(hog_the_processor);
  EXPECT_EQ(child.wait(), 0);
  EXPECT_EQ(child.log().last, -1);
}

}  // namespace
}  // namespace tessera::testing
