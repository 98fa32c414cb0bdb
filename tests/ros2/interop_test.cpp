// The drivers against Fast DDS, which has its own protocol, its own discovery and its own CDR.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <thread>

#include "bindings.hpp"
#include "eventually.hpp"
#include "fast_peer.hpp"
#include "ros2/dds/clock.hpp"
#include "stderr_text.hpp"
#include "tessera/bounded_string.hpp"
#include "tessera/fields.hpp"

namespace tessera::ros2 {
namespace {

struct Scan {
  float range_max{};
  std::array<double, 5> ranges{};
  TESSERA_FIELDS(Scan, range_max, ranges)
};
struct Odometry {
  double x{}, speed{};
  TESSERA_FIELDS(Odometry, x, speed)
};

// A DDS reader receives no sample that was written before it has found the writer, even if the writer has
// found it already. So a single sample may be lost, and these tests send until one arrives.
class WithFastDds : public testing::Test {
 protected:
  fast::Peer peer{test_domain()};
};

TEST_F(WithFastDds, GetsEveryTwistOfASecondAtOneKilohertz) {
  auto* const reader = peer.reader<fast::Twist>("rt/cmd_vel");
  auto effector =
      opened_effector(binding<Motion>("/cmd_vel", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega"));
  ASSERT_TRUE(eventually([&] { return fast::Peer::is_matched(*reader); }));
  ASSERT_TRUE(eventually([&] {  // the writer knows the reader once a sample arrives
    EXPECT_TRUE(write(*effector, Motion{-1, 0}));
    return fast::Peer::take<fast::Twist>(*reader).has_value();
  }));
  const char* const seconds = std::getenv("TESSERA_ROS2_SECONDS");
  const int count = 1000 * (seconds == nullptr ? 1 : std::atoi(seconds));
  int received = 0;
  const auto take_all = [&] {
    while (const auto twist = fast::Peer::take<fast::Twist>(*reader)) {
      if (twist->linear_x < 0) continue;
      EXPECT_EQ(twist->linear_x, received);
      EXPECT_EQ(twist->angular_z, 0.5 * received);
      EXPECT_EQ(twist->linear_y, 0);
      ++received;
    }
    return received >= count;
  };
  auto next = std::chrono::steady_clock::now();
  for (int number = 0; number < count; ++number) {
    ASSERT_TRUE(write(*effector, Motion{static_cast<double>(number), 0.5 * number}));
    // On a busy machine the receiving thread may sleep for longer than its buffers last.
    ASSERT_TRUE(eventually([&] {
      take_all();
      return number - received < 50;
    }));
    std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(eventually(take_all)) << received;
  effector->close();
}

TEST_F(WithFastDds, GivesTwistsAndEachIsFreshOnce) {
  auto* const writer = peer.writer<fast::Twist>("rt/cmd_vel");
  auto receptor =
      opened_receptor(binding<Motion>("/cmd_vel", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega"));
  Motion motion{7, 7};
  EXPECT_FALSE(read(*receptor, motion));
  EXPECT_EQ(motion.v, 7);
  ASSERT_TRUE(eventually([&] { return fast::Peer::is_matched(*writer); }));
  fast::Twist twist;
  twist.linear_x = 0.25;
  twist.angular_z = -3;
  ASSERT_TRUE(eventually([&] {
    writer->write(&twist);
    return read(*receptor, motion);
  }));
  EXPECT_EQ(motion.v, 0.25);
  EXPECT_EQ(motion.omega, -3);
  twist.linear_x = 0.5;
  writer->write(&twist);
  // More than one of the first kind may still be on the way.
  ASSERT_TRUE(eventually([&] { return read(*receptor, motion) && motion.v == 0.5; }));
  EXPECT_FALSE(read(*receptor, motion));
  receptor->close();
}

TEST_F(WithFastDds, GivesScansOfABestEffortSensorAndDropsThoseOfAnotherLength) {
  auto* const writer = peer.writer<fast::LaserScan>("rt/scan", /*reliable=*/false);
  auto sensor = binding<Scan>("/scan", "sensor_msgs/msg/LaserScan");
  sensor.qos = "sensor";
  auto receptor = opened_receptor(sensor);
  fast::LaserScan scan;
  scan.header.frame_id = "laser";
  scan.range_max = 12;
  scan.ranges = {1, 2, std::numeric_limits<float>::infinity(), 0.5F, 4};
  Scan seen;
  ASSERT_TRUE(eventually([&] {
    writer->write(&scan);
    return read(*receptor, seen);
  }));
  EXPECT_EQ(seen.range_max, 12);
  EXPECT_EQ(seen.ranges[1], 2);
  EXPECT_TRUE(std::isinf(seen.ranges[2]));
  scan.ranges.pop_back();
  scan.range_max = 13;
  testing::internal::CaptureStderr();
  std::string told;
  for (int number = 0; number < 3; ++number) writer->write(&scan);
  scan.ranges.push_back(9);
  scan.range_max = 14;
  EXPECT_TRUE(eventually([&] {
    writer->write(&scan);
    return read(*receptor, seen) && seen.range_max == 14;
  }));
  told = testing::internal::GetCapturedStderr();
  EXPECT_NE(told.find("robot.part.buffer: a message of /scan was dropped (1 until now): an array or text has "
                      "another length"),
            std::string::npos)
      << told;
  EXPECT_EQ(seen.ranges[4], 9);
  receptor->close();
}

TEST_F(WithFastDds, GivesOdometryAndStrings) {
  auto* const odometry = peer.writer<fast::Odometry>("rt/odom");
  auto* const words = peer.writer<fast::Text>("rt/words");
  auto wheels = opened_receptor(binding<Odometry>("odom", "nav_msgs/msg/Odometry",
                                                  "pose.pose.position.x=x, twist.twist.linear.x=speed"));
  auto ear = opened_receptor(binding<BoundedString<16>>("/words", "std_msgs/msg/String"));
  ASSERT_TRUE(
      eventually([&] { return fast::Peer::is_matched(*odometry) && fast::Peer::is_matched(*words); }));
  fast::Odometry sent;
  sent.header.frame_id = "odom";
  sent.child_frame_id = "base_link";
  sent.x = 2.5;
  sent.twist.linear_x = 0.75;
  fast::Text text{"halt"};
  Odometry got;
  BoundedString<16> heard;
  EXPECT_TRUE(eventually([&] {
    odometry->write(&sent);
    return read(*wheels, got);
  }));
  EXPECT_TRUE(eventually([&] {
    words->write(&text);
    return read(*ear, heard);
  }));
  EXPECT_EQ(got.x, 2.5);
  EXPECT_EQ(got.speed, 0.75);
  EXPECT_EQ(heard.view(), "halt");
}

TEST_F(WithFastDds, MovesAnArmWhoseJointsHaveAnotherOrder) {
  auto* const state = peer.writer<fast::JointState>("rt/joint_states");
  auto* const commands = peer.reader<fast::Float64MultiArray>("rt/commands");
  auto joints = binding<std::array<double, 3>>("/joint_states", "sensor_msgs/msg/JointState", "position");
  joints.names = "base, shoulder, elbow";
  auto receptor = opened_receptor(joints);
  auto effector =
      opened_effector(binding<std::array<double, 3>>("/commands", "std_msgs/msg/Float64MultiArray"));
  ASSERT_TRUE(
      eventually([&] { return fast::Peer::is_matched(*state) && fast::Peer::is_matched(*commands); }));
  fast::JointState sent;
  sent.names = {"gripper", "elbow", "base", "shoulder"};
  sent.position = {0.5, 3, 1, 2};
  std::array<double, 3> positions{};
  ASSERT_TRUE(eventually([&] {
    state->write(&sent);
    return read(*receptor, positions);
  }));
  EXPECT_EQ(positions, (std::array<double, 3>{1, 2, 3}));
  std::optional<fast::Float64MultiArray> command;
  ASSERT_TRUE(eventually([&] {
    EXPECT_TRUE(write(*effector, positions));
    return (command = fast::Peer::take<fast::Float64MultiArray>(*commands)).has_value();
  }));
  EXPECT_EQ(command->data, (std::vector<double>{1, 2, 3}));
}

TEST_F(WithFastDds, IsANodeForToolsOfRos2) {
  auto* const nodes = peer.reader<fast::OneWriter>("ros_discovery_info", /*transient_local=*/true);
  auto effector =
      opened_effector(binding<Motion>("/cmd_vel", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega"));
  std::optional<fast::OneWriter> node;
  ASSERT_TRUE(eventually([&] { return (node = fast::Peer::take<fast::OneWriter>(*nodes)).has_value(); }));
  EXPECT_EQ(node->nodes, 1U);
  EXPECT_EQ(node->node_namespace, "/");
  EXPECT_EQ(node->node_name, "robot");
  EXPECT_EQ(node->readers, 0U);
  EXPECT_EQ(node->writers, 1U);
  // Endpoints begin like their participant and end in what they are.
  EXPECT_TRUE(std::equal(node->participant.begin(), node->participant.begin() + 12, node->writer.begin()));
  EXPECT_NE(node->participant, node->writer);
  EXPECT_EQ(node->participant.back(), 0xc1);
}

TEST_F(WithFastDds, TellsOfAPublisherWithAnotherReliability) {
  const StderrText told;
  auto* const writer = peer.writer<fast::Text>("rt/words", /*reliable=*/false);
  auto ear = opened_receptor(binding<BoundedString<16>>("/words", "std_msgs/msg/String"));
  fast::Text text{"unheard"};
  EXPECT_TRUE(eventually([&] {
    writer->write(&text);
    return told.has("a publisher offers another reliability of /words than ours");
  })) << told.now();
  BoundedString<16> heard;
  EXPECT_FALSE(read(*ear, heard));
}

TEST_F(WithFastDds, PublishesTheTimeOfASimulatedRunAndStampsItsMessagesWithIt) {
  setenv("ROS_DOMAIN_ID", std::to_string(test_domain()).c_str(), 1);
  EXPECT_GT(stamp_now().sec, 1'600'000'000) << "the system clock";
  auto* const clocks = peer.reader<fast::Clock>("rt/clock");
  std::string error;
  auto clock = make_clock("lo", error);
  ASSERT_NE(clock, nullptr) << error;
  std::optional<fast::Clock> got;
  ASSERT_TRUE(eventually([&] {
    clock->publish(std::chrono::milliseconds(2750));
    return (got = fast::Peer::take<fast::Clock>(*clocks)).has_value();
  }));
  EXPECT_EQ(got->sec, 2);
  EXPECT_EQ(got->nanosec, 750'000'000U);
  clock->set(std::chrono::milliseconds(3001));
  EXPECT_EQ(stamp_now().sec, 3);
  EXPECT_EQ(stamp_now().nanosec, 1'000'000U);
  clock.reset();
  EXPECT_GT(stamp_now().sec, 1'600'000'000);
  EXPECT_EQ(make_clock("no such", error), nullptr);
  EXPECT_EQ(error, "'no such' is no name and no address of a network interface");
}

TEST_F(WithFastDds, WaitsForTheOtherSideIfAsked) {
  auto waiting = binding<Motion>("/nobody", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega");
  waiting.wait = std::chrono::milliseconds(50);
  std::string error;
  const auto effector = make_effector(waiting, error);
  ASSERT_NE(effector, nullptr) << error;
  try {
    static_cast<void>(effector->open());
    FAIL();
  } catch (const std::runtime_error& problem) {
    EXPECT_STREQ(problem.what(), "there is no subscriber of /nobody");
  }
}

}  // namespace
}  // namespace tessera::ros2
