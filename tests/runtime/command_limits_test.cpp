// Limits of real outputs: by themselves, and in a run.

#include "drivers/command_limits.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "nets.hpp"
#include "tessera/recording.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

struct Pose {
  double x = 0;
  float y = 0;
};

struct Motor {
  Output<double> left;
  Output<Pose> pose;
  Output<std::array<float, 3>> joints;
  Output<std::int8_t> step;
};

/// The allowed commands at one moment, if all are `asked`.
struct Limited : ::testing::Test {
  Limited() {
    bindings.real_output("left", out.left, 1.0);
    bindings.limit("left", payload(out.left), {.minimum = -10, .maximum = 10, .per_second = 100});
    bindings.real_output("pose", out.pose, Pose{0.5, 0});
    bindings.limit("pose.x", out.pose.x, {.minimum = 0, .maximum = 2, .fault = true});
    bindings.real_output("joints", out.joints, std::array<float, 3>{});
    bindings.limit("joints", payload(out.joints), {.maximum = 3});
    bindings.real_output("step", out.step, std::int8_t{0});
    bindings.limit("step", payload(out.step), {.minimum = -1.5, .maximum = 2.5});
  }
  static constexpr double none_ = std::numeric_limits<double>::quiet_NaN();
  Bindings bindings;
  Motor out;
};

TEST_F(Limited, RangesHoldForNumbersElementsAndIntegers) {
  CommandLimits limits(bindings, 1s);
  out.left = 50;
  payload(out.joints) = {1, 4, 9};
  out.step = 100;
  out.pose.x = 2;
  const CommandLimits::Excess* const excess = limits.apply(Time(1s));
  ASSERT_NE(excess, nullptr);
  EXPECT_EQ(excess->name, "left");
  EXPECT_EQ(excess->asked, 50);
  EXPECT_EQ(excess->sent, 10);
  EXPECT_FALSE(excess->fault);
  EXPECT_EQ(out.left, 10);
  EXPECT_EQ(payload(out.joints), (std::array<float, 3>{1, 3, 3}));
  EXPECT_EQ(out.step, 2) << "whole numbers within the range";
  out.step = -100;
  static_cast<void>(limits.apply(Time(2s)));
  EXPECT_EQ(out.step, -1);
}

TEST_F(Limited, TheChangeIsThatOfOnePeriodAndBeginsAtTheSafeCommand) {
  CommandLimits limits(bindings, 10ms);
  const auto sent = [&](Time at) {
    out.left = 10;
    static_cast<void>(limits.apply(at));
    limits.note_sent(at);
    return out.left.value();
  };
  EXPECT_DOUBLE_EQ(sent(Time(10ms)), 2) << "1, the safe command, and 100 a second for 10 ms";
  EXPECT_DOUBLE_EQ(sent(Time(15ms)), 2.5);
  EXPECT_DOUBLE_EQ(sent(Time(5s)), 3.5) << "a pause does not save up a jump";
  limits.note_safe(Time(5s));
  EXPECT_DOUBLE_EQ(sent(Time(5010ms)), 2);
}

TEST_F(Limited, NaNIsNoCommandAndChangesAreCountedFromTheLastNumber) {
  CommandLimits limits(bindings, 10ms);
  const auto sent = [&](double asked, Time at) {
    out.left = asked;
    const bool exceeds = limits.apply(at) != nullptr;
    limits.note_sent(at);
    return std::pair(out.left.value(), exceeds);
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto [nan, exceeds] = sent(none, Time(10ms));
  EXPECT_TRUE(std::isnan(nan));
  EXPECT_FALSE(exceeds);
  EXPECT_EQ(sent(10, Time(20ms)), std::pair(2.0, true)) << "1, the safe command, and 100 a second for 10 ms";
  EXPECT_EQ(sent(Bindings::Limits::infinity, Time(30ms)).first, 3.0);
}

TEST_F(Limited, InfinityWithoutALimitDoesNotHoldTheNextCommand) {
  Output<double> free;
  bindings.real_output("free", free, none_);
  bindings.limit("free", payload(free), {.minimum = 0});
  CommandLimits limits(bindings, 10ms);
  free = Bindings::Limits::infinity;
  static_cast<void>(limits.apply(Time(10ms)));
  limits.note_sent(Time(10ms));
  EXPECT_EQ(free, Bindings::Limits::infinity);
  free = 4;
  static_cast<void>(limits.apply(Time(20ms)));
  EXPECT_EQ(free, 4);
}

TEST_F(Limited, AFaultIsToldBeforeWhatIsOnlyLimitedAndTheRestOncePerTime) {
  CommandLimits limits(bindings, 1s);
  out.left = 50;
  out.pose.x = 3;
  const CommandLimits::Excess* excess = limits.apply(Time(1s));
  ASSERT_NE(excess, nullptr);
  EXPECT_EQ(excess->name, "pose.x");
  EXPECT_TRUE(excess->fault);
  out.pose.x = 1;
  out.left = 50;
  EXPECT_EQ(limits.apply(Time(2s)), nullptr) << "left goes on as it did";
  out.left = 5;
  EXPECT_EQ(limits.apply(Time(3s)), nullptr);
  out.left = 50;
  EXPECT_NE(limits.apply(Time(4s)), nullptr);
}

/// An effector that asks for 7 at once, with a limit of 3 and 100 a second.
RunSummary run_limited(TestSystem& system, bool fault, std::string recording = "") {
  Script script;
  script.acts = true;
  script.safe = 0;
  script.limits = {.minimum = -3, .maximum = 3, .per_second = 100, .fault = fault};
  script.call = [](ScriptState& state) { state.command = 7; };
  script.decide = [](const ScriptState&) { return Outcome::go_on; };
  system.add("robot.motor", nets::alone, script, 10ms, 0ms, Kind::effector);
  RunOptions options = simulated(45ms);
  options.recording = std::move(recording);
  return run(system, options);
}

TEST(CommandsInARun, AreClampedAndTheRecordingHasWhatWasSent) {
  TestSystem system;
  const std::string file = scratch_file("limited.tsr");
  EXPECT_FALSE(run_limited(system, false, file).failed);
  EXPECT_EQ(system.devices.commands, (std::vector<double>{0, 1, 2, 3, 3, 0}));
  const std::string bytes = file_bytes(file);
  EXPECT_NE(bytes.find("real output 'command' is limited to 0 (7 was asked for)"), std::string::npos);
  const auto holds = [&](double value) {
    return bytes.find(std::string_view(reinterpret_cast<const char*>(&value), sizeof value)) !=
           std::string::npos;
  };
  EXPECT_TRUE(holds(2));
  EXPECT_FALSE(holds(7)) << "what was not sent is not recorded as if it were";
}

TEST(CommandsInARun, BeyondALimitThatIsAFaultGiveTheSafeCommand) {
  TestSystem system;
  const std::string file = scratch_file("fault.tsr");
  static_cast<void>(run_limited(system, true, file));
  EXPECT_EQ(std::count(system.devices.commands.begin(), system.devices.commands.end(), 0.0),
            static_cast<std::ptrdiff_t>(system.devices.commands.size()));
  EXPECT_NE(file_bytes(file).find("the command 7 to real output 'command' is beyond its limits"),
            std::string::npos);
}

}  // namespace
}  // namespace tessera::testing
