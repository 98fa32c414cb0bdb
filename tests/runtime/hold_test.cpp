// A run that another process holds and lets go on.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <functional>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include "child_run.hpp"
#include "managed/run_orders.hpp"
#include "nets.hpp"
#include "tessera/recording.hpp"
#include "tessera/signals.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// A run in a child process, which this process holds: sensor -> motor, which commands 5 and whose safe command is -1.
class HeldRun {
 public:
  /// call: of the motor, after the command.
  explicit HeldRun(
      const std::string& recording = "", const std::function<void(CommandLog&)>& call = [](CommandLog&) {},
      Duration timeout = 0ms)
      : child_([&](CommandLog& log) {
          close(ends_[0]);
          return drive(log, recording, call, timeout);
        }) {
    close(ends_[1]);
  }
  HeldRun(const HeldRun&) = delete;
  HeldRun& operator=(const HeldRun&) = delete;
  ~HeldRun() {
    leave();
    munmap(calls_, sizeof(Calls));
  }

  void order(RunOrders::Order order) const {
    const char byte = static_cast<char>(order);
    ASSERT_EQ(send(ends_[0], &byte, 1, MSG_NOSIGNAL), 1);
  }
  /// Waits for the next state; 0: the run has ended.
  [[nodiscard]] char told() const {
    char byte = 0;
    return recv(ends_[0], &byte, 1, 0) == 1 ? byte : '\0';
  }
  void leave() {
    if (ends_[0] >= 0) close(ends_[0]);
    ends_[0] = -1;
  }
  [[nodiscard]] ChildRun& child() { return child_; }
  [[nodiscard]] std::uint64_t commands() { return child_.log().commands; }
  /// How often the function of the control, which has no device, was called.
  [[nodiscard]] std::uint64_t calls() const { return *calls_; }

 private:
  static std::array<int, 2> socket_ends() {
    std::array<int, 2> ends{-1, -1};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
    return ends;
  }
  int drive(CommandLog& log, const std::string& recording, const std::function<void(CommandLog&)>& call,
            Duration timeout) const {
    TestSystem system;
    Script motor;
    motor.acts = true;
    motor.call = [&](ScriptState& state) {
      state.command = 5;
      call(log);
    };
    system.devices.accept = [&log](double value) {
      log.note(value, -1);
      return true;
    };
    Script control;
    control.call = [this](ScriptState&) { ++*calls_; };
    const auto a = system.add("robot.control", nets::nb_sender, control, 1ms);
    const auto b = system.add("robot.motor", nets::b_receiver, motor, 0ms, 1min, Kind::effector);
    system.connect(a, "x", b, "x", buffered, timeout, timeout);
    RunOptions options = steady(1h);
    options.recording = recording;
    options.orders = ends_[1];
    std::string error;
    const std::optional<RunSummary> summary = execute(system.system(), options, error);
    if (!summary || summary->failed) return 1;
    return summary->signal == 0 ? 0 : 128 + summary->signal;
  }

  using Calls = std::atomic<std::uint64_t>;
  std::array<int, 2> ends_ = socket_ends();
  Calls* calls_ =
      new (mmap(nullptr, sizeof(Calls), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) Calls(0);
  ChildRun child_;
};

using Order = RunOrders::Order;
constexpr char held = static_cast<char>(RunOrders::State::held),
               runs = static_cast<char>(RunOrders::State::runs);

TEST(HeldRun, CommandsNothingButTheSafeCommandUnlessItGoesOn) {
  HeldRun run;
  ASSERT_EQ(run.told(), held);
  for (int round = 0; round < 3; ++round) {
    const std::uint64_t before = run.commands(), calls = run.calls();
    std::this_thread::sleep_for(20ms);
    EXPECT_EQ(run.commands(), before);
    EXPECT_LE(run.calls(), calls + 1) << "besides the call that was about to be made";
    EXPECT_EQ(run.child().log().last, -1);
    run.order(Order::go_on);
    ASSERT_EQ(run.told(), runs);
    ASSERT_TRUE(run.child().await_commands(5));
    run.order(Order::hold);
    ASSERT_EQ(run.told(), held);
  }
  run.order(Order::end);
  EXPECT_EQ(run.told(), '\0');
  EXPECT_EQ(run.child().wait(), 0);
  EXPECT_EQ(run.child().log().last, -1);
}

TEST(HeldRun, EndsSafelyWhenItsHolderIsGone) {
  for (const bool goes_on : {false, true}) {
    HeldRun run;
    ASSERT_EQ(run.told(), held);
    if (goes_on) {
      run.order(Order::go_on);
      ASSERT_TRUE(run.child().await_commands(5));
    }
    run.leave();
    EXPECT_EQ(run.child().wait(), 0);
    EXPECT_EQ(run.child().log().last, -1);
    EXPECT_TRUE(goes_on || run.commands() == 0);
  }
}

TEST(HeldRun, ObeysSignals) {
  HeldRun run;
  ASSERT_EQ(run.told(), held);
  run.child().kill(SIGTSTP);
  ASSERT_EQ(run.child().wait(), 2000 + SIGSTOP);
  run.child().kill(SIGCONT);
  run.order(Order::hold);
  ASSERT_EQ(run.told(), held) << "still";
  EXPECT_EQ(run.commands(), 0U);
  run.order(Order::go_on);
  ASSERT_EQ(run.told(), runs);
  ASSERT_TRUE(run.child().await_commands(5));
  run.order(Order::hold);
  ASSERT_EQ(run.told(), held);
  run.child().kill(SIGTERM);
  EXPECT_EQ(run.child().wait(), 128 + SIGTERM);
  EXPECT_EQ(run.child().log().last, -1);
}

TEST(HeldRun, HasNoTimeWhileItIsHeldAndKeepsItsMarking) {
  const std::string recording = scratch_file("run");
  constexpr Duration timeout = 300ms;
  HeldRun run(
      recording, [](CommandLog&) {}, timeout);
  ASSERT_EQ(run.told(), held);
  run.order(Order::go_on);
  ASSERT_EQ(run.told(), runs);
  ASSERT_TRUE(run.child().await_commands(5));
  const auto begin = std::chrono::steady_clock::now();
  run.order(Order::hold);
  ASSERT_EQ(run.told(), held);
  const auto must_not_count = 2 * timeout;
  std::this_thread::sleep_for(must_not_count);
  run.order(Order::go_on);
  ASSERT_EQ(run.told(), runs);
  const auto at_most = std::chrono::steady_clock::now() - begin - must_not_count;
  ASSERT_TRUE(run.child().await_commands(5));
  run.order(Order::end);
  EXPECT_EQ(run.child().wait(), 0);
  std::string error;
  const auto read = read_recording(recording, error);
  ASSERT_TRUE(read) << error;
  std::int64_t held_ns = -1, again_ns = -1;
  for (const auto& [event, text] : read->entries) {
    if (event.kind() == Event::Kind::log && text.starts_with("held")) held_ns = event.time_ns;
    if (event.kind() == Event::Kind::log && text.starts_with("goes on")) again_ns = event.time_ns;
  }
  ASSERT_GT(held_ns, 0);
  EXPECT_LE(std::chrono::nanoseconds(again_ns - held_ns), at_most);
}

TEST(HeldRun, DoesNotWaitForAFunctionWhoseDevicesAreSafe) {
  std::array<int, 2> door{};
  ASSERT_EQ(pipe(door.data()), 0);
  HeldRun run("", [&](CommandLog& log) {
    static bool waited = false;
    char byte = 0;
    if (log.commands == 4 && !std::exchange(waited, true)) [[maybe_unused]]
      const ssize_t got = read(door[0], &byte, 1);
  });
  ASSERT_EQ(run.told(), held);
  run.order(Order::go_on);
  ASSERT_EQ(run.told(), runs);
  ASSERT_TRUE(run.child().await([&] { return run.commands() == 4; }));  // the next call does not return
  run.order(Order::hold);
  ASSERT_EQ(run.told(), held);
  const std::uint64_t before = run.commands();
  ASSERT_EQ(write(door[1], "x", 1), 1);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(run.commands(), before) << "its command comes from before the hold";
  EXPECT_EQ(run.child().log().last, -1);
  run.order(Order::go_on);
  ASSERT_EQ(run.told(), runs);
  EXPECT_TRUE(run.child().await_commands(5));
}

TEST(HeldRun, TheSimulatedClockIsNotHeld) {
  TestSystem system;
  system.add("robot.control", nets::alone, {}, 1ms);
  RunOptions options = simulated(1s);
  options.orders = 0;
  std::string error;
  EXPECT_FALSE(execute(system.system(), options, error));
  EXPECT_EQ(error, "the simulated clock cannot be held by another process");
}

}  // namespace
}  // namespace tessera::testing
