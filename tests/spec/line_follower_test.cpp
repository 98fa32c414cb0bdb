#include <numbers>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

using std::chrono::milliseconds;

class LineFollower : public testing::Test {
 protected:
  LineFollower() : reading_(golden("valid/line_follower.yaml")) {}
  void SetUp() override { ASSERT_TRUE(reading_.model) << reading_.report(); }
  [[nodiscard]] const Model& model() const { return *reading_.model; }

  Reading reading_;
};

TEST_F(LineFollower, HasOneAgentOfThreeSubsystemsControlFirst) {
  EXPECT_EQ(model().system, "line_follower");
  ASSERT_EQ(model().agents.size(), 1U);
  EXPECT_EQ(model().agents[0].path, "robot");
  EXPECT_FALSE(model().agents[0].fleet.valid());
  ASSERT_EQ(model().instances.size(), 3U);
  EXPECT_EQ(model().instance_path({0}), "robot.control");
  EXPECT_EQ(model().instance_path({1}), "robot.sensor");
  EXPECT_EQ(model().instance_path({2}), "robot.motor");
  EXPECT_EQ(model().subsystem({0}).period, milliseconds(50));
  EXPECT_EQ(model().subsystem({2}).kind, SubsystemKind::effector);
  EXPECT_EQ(model().subsystem({2}).stale, milliseconds(500));
  EXPECT_EQ(model().subsystem({2}).safe, (std::vector<std::string>{"0.0", "0.0"}));
}

TEST_F(LineFollower, InitIsFollowedByFollowWhichNeverEnds) {
  const auto& behaviours = model().subsystem({0}).behaviours;
  ASSERT_EQ(behaviours.size(), 2U);
  EXPECT_EQ(model().subsystem({0}).start.value, 0U);
  EXPECT_EQ(behaviours[0].terminal.kind, Condition::Kind::always);
  ASSERT_EQ(behaviours[0].next.size(), 2U);
  EXPECT_EQ(behaviours[0].next[0].behaviour.value, 1U);
  EXPECT_TRUE(behaviours[0].next[1].implied) << "a failure ends the subsystem";
  EXPECT_TRUE(behaviours[0].next_given);
  EXPECT_EQ(behaviours[1].terminal.kind, Condition::Kind::never);
  ASSERT_EQ(behaviours[1].next.size(), 1U);
  EXPECT_FALSE(behaviours[1].next[0].behaviour.valid());
  EXPECT_FALSE(behaviours[1].next_given);
}

TEST_F(LineFollower, ChannelsHaveTheirModesAndNames) {
  ASSERT_EQ(model().channels.size(), 2U);
  const Channel& line = model().channels[0];
  EXPECT_EQ(model().channel_name(line), "robot.sensor.line->robot.control.line");
  EXPECT_EQ(line.send, Mode::non_blocking);
  EXPECT_EQ(line.receive, Mode::non_blocking);
  EXPECT_FALSE(line.receive_timeout);
  const Channel& motion = model().channels[1];
  EXPECT_EQ(model().channel_name(motion), "robot.control.motion->robot.motor.velocity");
  EXPECT_EQ(motion.receive, Mode::blocking);
  EXPECT_EQ(motion.receive_timeout, milliseconds(200));
  EXPECT_FALSE(motion.send_timeout);
  EXPECT_EQ(motion.span, (Span{32, 13, 20}));
}

TEST_F(LineFollower, TypesAndParametersHaveUnits) {
  ASSERT_EQ(model().structures.size(), 2U);
  EXPECT_EQ(model().structures[1].name, "Velocity");
  EXPECT_EQ(model().structures[1].fields[1].type.unit, "rad/s");
  ASSERT_EQ(model().parameters.size(), 2U);
  EXPECT_EQ(model().parameters[0].initial, "0.2");
  EXPECT_EQ(model().parameters[1].initial, "2.0");
  EXPECT_EQ(model().parameters[1].type.unit, "rad/s");
}

TEST_F(LineFollower, SimulationHasTrackAndDrivers) {
  ASSERT_TRUE(model().simulation && model().simulation->track);
  const Track& track = *model().simulation->track;
  EXPECT_EQ(model().simulation->world, "line_world.xml");
  EXPECT_EQ(track.image, "oval.png");
  EXPECT_DOUBLE_EQ(*track.start_x_m, 0.4);
  EXPECT_DOUBLE_EQ(*track.start_heading_rad, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(track.footprint_m, 0.008);
  ASSERT_EQ(model().simulation->drivers.size(), 2U);
  const Driver& wheel = model().simulation->drivers[1];
  EXPECT_EQ(wheel.kind, "velocity");
  EXPECT_EQ(wheel.target(), "wheel_left");
  EXPECT_EQ(wheel.instance.value, 2U);
}

TEST_F(LineFollower, PropertiesAreKept) {
  ASSERT_EQ(model().properties.size(), 1U);
  EXPECT_EQ(model().properties[0].name, "motors can always run");
  EXPECT_EQ(model().properties[0].kind, Property::Kind::always_reachable);
  EXPECT_EQ(model().properties[0].text, "robot.motor.drive");
}

}  // namespace
}  // namespace tessera::spec
