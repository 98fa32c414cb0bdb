// A run as nodes of ROS 2 show it.
#include "watch/ros2_host.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "parameters/parameter_changes.hpp"
#include "parameters/ros2_parameters.hpp"
#include "tessera/bounded_string.hpp"

namespace tessera {
namespace {

struct OneOfEachKind {
  double gain = 0.5;
  float small = 0.1F;
  std::int8_t level = -3;
  bool on = true;
  BoundedString<8> label{};
  std::array<std::uint16_t, 2> steps{1, 2};
  struct {
    double x = 1, y = 2;
  } place;
  Bindings bindings;

  OneOfEachKind() {
    label = "red";
    bindings.parameter("gain", gain, {0, 10, "m/s"});
    bindings.parameter("small", small, {});
    bindings.parameter("level", level, {-8, 8, ""});
    bindings.parameter("on", on, {});
    bindings.parameter("place", place, {});
    bindings.parameter("label", label, {});
    bindings.parameter("steps", steps, {0, 100, ""});
  }
  [[nodiscard]] ParameterOwner owner(const std::string& path) const { return {path, bindings.parameters}; }
};

TEST(ShownInRos2, ParametersHaveKindsLimitsAndTheNewestValues) {
  const OneOfEachKind one;
  ParameterChanges changes({one.owner("robot.control")});
  ASSERT_FALSE(changes.ask("robot.control.small", "0.3"));
  const auto shown = ros2_parameters(changes.owners(), changes.offered());
  std::string all;
  for (const Ros2Parameter& parameter : shown)
    all += parameter.path + " " + std::to_string(static_cast<int>(parameter.kind)) + " " + parameter.value +
           "\n";
  EXPECT_EQ(all,
            "robot.control.gain 3 0.5\nrobot.control.small 3 0.3\nrobot.control.level 2 -3\nrobot.control.on "
            "1 true\n"
            "robot.control.label 4 red\nrobot.control.steps 7 [1, 2]\n");
  EXPECT_EQ(shown[0].maximum, 10);
  EXPECT_EQ(shown[0].unit, "m/s");
  EXPECT_EQ(shown[4].longest, 8U);
  EXPECT_EQ(shown[5].elements, 2U);
}

TEST(ShownInRos2, SeveralParametersChangeTogetherOrNotAtAll) {
  const OneOfEachKind one, other;
  ParameterChanges changes({one.owner("robot.control"), other.owner("robot.arm")});
  using Values = std::vector<std::pair<std::string, std::string>>;
  const auto wrong = changes.ask_all(Values{{"robot.control.gain", "2"}, {"robot.arm.level", "9"}});
  ASSERT_TRUE(wrong);
  EXPECT_EQ(wrong->text, "parameter robot.arm.level = 9: 9 is out of range -8 to 8");
  const auto nothing = [](const std::string&) { ADD_FAILURE() << "nothing was asked"; };
  changes.take(0, nothing);
  EXPECT_EQ(changes.offered()[0].value, "0.5");
  ASSERT_FALSE(changes.ask_all(
      Values{{"robot.control.gain", "2"}, {"robot.arm.level", "-8"}, {"robot.control.on", "false"}}));
  EXPECT_EQ(one.gain, 0.5) << "the subsystem takes it";
  std::string told;
  changes.take(0, [&](const std::string& text) { told += text + "\n"; });
  EXPECT_EQ(told, "robot.control.gain=2\nrobot.control.on=false\n");
  EXPECT_EQ(one.gain, 2);
  EXPECT_FALSE(one.on);
  changes.take(1, [](const std::string&) {});
  EXPECT_EQ(other.level, -8);
}

TEST(ShownInRos2, StatusesTellOfFaultsNewOverrunsWaitsAndStops) {
  using enum Ros2Status::Level;
  Ros2Statuses statuses;
  Snapshot snapshot;
  snapshot.time_s = 5;
  snapshot.subsystems.resize(2);
  snapshot.subsystems[0].path = "robot.control";
  snapshot.subsystems[0].behaviour = "follow";
  snapshot.subsystems[0].overruns = 2;
  snapshot.subsystems[1].path = "robot.arm";
  auto shown = statuses.of(snapshot);
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown[0].level, warn);
  EXPECT_EQ(shown[0].message, "2 new overruns");
  EXPECT_EQ(shown[1].level, ok);
  EXPECT_EQ(shown[1].message, "has not begun");
  snapshot.waits.push_back(
      {.subsystem = "robot.arm", .waits_for = "robot.control", .channel = "c", .process = {}, .since_s = 3});
  shown = statuses.of(snapshot);
  EXPECT_EQ(shown[0].level, ok) << "the overruns are old";
  EXPECT_EQ(shown[0].message, "follow");
  EXPECT_EQ(shown[1].level, ok);
  EXPECT_EQ(shown[1].message, "waits for robot.control (2.0 s)");
  snapshot.subsystems[1].slow_calls = 2;
  snapshot.subsystems[1].late_wakeups = 1;
  shown = statuses.of(snapshot);
  EXPECT_EQ(shown[1].level, warn);
  EXPECT_EQ(shown[1].message, "overtime: 3 new");
  snapshot.subsystems[0].errors = 1;
  snapshot.subsystems[1].ended = true;
  shown = statuses.of(snapshot);
  EXPECT_EQ(shown[0].level, error);
  EXPECT_EQ(shown[0].message, "1 fault");
  EXPECT_EQ(shown[1].level, stale);
  snapshot.emergency = "an operator asks for it";
  for (const Ros2Status& one : statuses.of(snapshot)) EXPECT_EQ(one.level, error) << one.path;
}

TEST(ShownInRos2, ProvedPropertiesAreThoseOfTheController) {
  const std::array verdicts{VerifiedProperty{"no deadlock", "holds", "circuits"},
                            VerifiedProperty{"safe", "holds", "place invariants"}};
  Ros2Status shown = proof_status("cart[3]", verdicts);
  EXPECT_EQ(shown.path, "cart[3].proved properties");
  EXPECT_EQ(shown.level, Ros2Status::Level::ok);
  EXPECT_EQ(shown.message, "2 of 2 hold");
  EXPECT_EQ(shown.values[0],
            std::pair(std::string("no deadlock"), std::string("holds (proved by circuits)")));
  const std::array others{verdicts[1], VerifiedProperty{"no deadlock", "violated", "search"},
                          VerifiedProperty{"docks", "unknown", ""}};
  shown = proof_status("robot", others);
  EXPECT_EQ(shown.level, Ros2Status::Level::warn);
  EXPECT_EQ(shown.message, "no deadlock: violated; docks: unknown");
  EXPECT_EQ(shown.values[2].second, "unknown");
  shown = proof_status("robot", {});
  EXPECT_EQ(shown.level, Ros2Status::Level::warn);
  EXPECT_EQ(shown.message, "not verified");
}

}  // namespace
}  // namespace tessera
