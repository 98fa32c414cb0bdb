// The drivers against Fast DDS, which has its own protocol, its own discovery and its own CDR.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "bindings.hpp"
#include "eventually.hpp"
#include "fast_peer.hpp"
#include "ros2/dds/clock.hpp"
#include "ros2/dds/other_writers.hpp"
#include "stderr_text.hpp"
#include "tessera/bounded_sequence.hpp"
#include "tessera/bounded_string.hpp"
#include "tessera/fields.hpp"
#include "tessera/large_sequence.hpp"

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
  EXPECT_NE(
      told.find(
          "robot.part.buffer: a message of /scan was dropped (1 until now): 'ranges' has 4 elements, and the "
          "buffer takes 5"),
      std::string::npos)
      << told;
  EXPECT_EQ(seen.ranges[4], 9);
  receptor->close();
}

/// Acts until standard error has the text.
std::string stderr_until(const std::string& text, const std::function<void()>& act) {
  const StderrText told;
  EXPECT_TRUE(eventually([&] {
    act();
    return told.has(text);
  })) << told.now();
  return told.now();
}

struct Step {
  double x{}, y{};
  BoundedString<8> frame;
  TESSERA_FIELDS(Step, x, y, frame)
};
struct Way {
  std::int32_t sec{};
  BoundedSequence<Step, 16> steps;
  TESSERA_FIELDS(Way, sec, steps)
};
constexpr const char* way_fields =
    "header.stamp.sec=sec, poses.pose.position.x=steps.x, poses.pose.position.y=steps.y, "
    "poses.header.frame_id=steps.frame";

fast::Path path_of(std::size_t length, std::int32_t sec) {
  fast::Path path;
  path.header.sec = sec;
  path.poses.resize(length);
  for (std::size_t index = 0; index < length; ++index) {
    path.poses[index].header.frame_id = std::string(index % 9, 'f');
    path.poses[index].pose = {static_cast<double>(index), -0.5 * static_cast<double>(index)};
  }
  return path;
}

TEST_F(WithFastDds, GivesPathsOfZeroToSixteenPosesAndDropsLongerOnes) {
  auto* const writer = peer.writer<fast::Path>("rt/path");
  auto receptor = opened_receptor(binding<Way>("/path", "nav_msgs/msg/Path", way_fields));
  Way way;
  for (std::size_t length = 0; length <= 16; ++length) {
    fast::Path path = path_of(length, static_cast<std::int32_t>(length) + 1);
    ASSERT_TRUE(eventually([&] {
      writer->write(&path);
      return read(*receptor, way) && way.sec == path.header.sec;
    })) << length;
    ASSERT_EQ(way.steps.size(), length);
    for (std::size_t index = 0; index < length; ++index) {
      EXPECT_EQ(way.steps[index].x, index);
      EXPECT_EQ(way.steps[index].y, -0.5 * static_cast<double>(index));
      EXPECT_EQ(way.steps[index].frame, std::string(index % 9, 'f'));
    }
  }
  fast::Path longer = path_of(17, 100), good = path_of(1, 101);
  const std::string told = stderr_until("was dropped", [&] {
    writer->write(&longer);
    writer->write(&good);
    static_cast<void>(read(*receptor, way));
  });
  EXPECT_NE(told.find("a message of /path was dropped (1 until now)"), std::string::npos) << told;
  EXPECT_TRUE(eventually([&] {
    writer->write(&good);
    return read(*receptor, way) && way.sec == 101;
  }));
  EXPECT_EQ(way.steps.size(), 1U);
  receptor->close();
}

TEST_F(WithFastDds, GetsPathsOfTheLengthOfTheBuffer) {
  auto* const reader = peer.reader<fast::Path>("rt/path");
  auto effector =
      opened_effector(binding<BoundedSequence<Step, 16>>("/path", "nav_msgs/msg/Path",
                                                         "poses.pose.position.x=x, poses.pose.position.y=y, "
                                                         "poses.header.frame_id=frame"));
  BoundedSequence<Step, 16> steps;
  for (std::size_t length = 0; length <= 16; ++length) {
    std::optional<fast::Path> path;
    ASSERT_TRUE(eventually([&] {
      EXPECT_TRUE(write(*effector, steps));
      while (auto next = fast::Peer::take<fast::Path>(*reader)) path = std::move(next);
      return path && path->poses.size() == length;
    })) << length;
    for (std::size_t index = 0; index < length; ++index) {
      EXPECT_EQ(path->poses[index].pose[0], index);
      EXPECT_EQ(path->poses[index].pose[1], 7);
      EXPECT_EQ(path->poses[index].header.frame_id, "map");
    }
    if (length < 16) steps.push_back({static_cast<double>(length), 7, "map"});
  }
  effector->close();
}

TEST_F(WithFastDds, GivesRangesOfTheLengthThatTheyHave) {
  auto* const writer = peer.writer<fast::LaserScan>("rt/ranges");
  auto receptor =
      opened_receptor(binding<LargeSequence<float, 1200>>("/ranges", "sensor_msgs/msg/LaserScan", "ranges"));
  LargeSequence<float, 1200> ranges;
  for (const std::size_t length : {0U, 1U, 1200U, 5U}) {
    fast::LaserScan scan;
    scan.ranges.assign(length, 0.25F);
    ASSERT_TRUE(eventually([&] {
      writer->write(&scan);
      return read(*receptor, ranges) && ranges.size() == length;
    })) << length;
    EXPECT_TRUE(std::all_of(ranges.begin(), ranges.end(), [](float one) { return one == 0.25F; }));
  }
  receptor->close();
}

TEST_F(WithFastDds, GetsAndGivesNumbersThatAreNotFinite) {
  auto* const reader = peer.reader<fast::Twist>("rt/setpoint");
  auto* const writer = peer.writer<fast::Twist>("rt/echo");
  auto effector =
      opened_effector(binding<Motion>("/setpoint", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega"));
  auto receptor =
      opened_receptor(binding<Motion>("/echo", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega"));
  std::optional<fast::Twist> twist;
  ASSERT_TRUE(eventually([&] {
    EXPECT_TRUE(write(*effector, Motion{std::numeric_limits<double>::quiet_NaN(),
                                        -std::numeric_limits<double>::infinity()}));
    twist = fast::Peer::take<fast::Twist>(*reader);
    return twist.has_value();
  }));
  EXPECT_TRUE(std::isnan(twist->linear_x));
  EXPECT_EQ(twist->angular_z, -std::numeric_limits<double>::infinity());
  Motion motion;
  ASSERT_TRUE(eventually([&] {
    writer->write(&*twist);
    return read(*receptor, motion);
  }));
  EXPECT_TRUE(std::isnan(motion.v));
  EXPECT_EQ(motion.omega, -std::numeric_limits<double>::infinity());
  effector->close();
  receptor->close();
}

TEST_F(WithFastDds, WarnsOfASecondPublisherOfItsTopicAndOfNoOtherOnes) {
  auto effector =
      opened_effector(binding<Motion>("/cmd_vel", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega"));
  // Neither a reader of the topic nor a writer of another one is a second writer.
  auto* const reader = peer.reader<fast::Twist>("rt/cmd_vel");
  auto* const other = peer.writer<fast::Twist>("rt/cmd_vel_2");
  static_cast<void>(other);
  ASSERT_TRUE(eventually([&] { return fast::Peer::is_matched(*reader); }));
  {
    const StderrText told;
    const auto until = std::chrono::steady_clock::now() + 3 * OtherWriters::between_looks;
    while (std::chrono::steady_clock::now() < until) {
      EXPECT_TRUE(write(*effector, Motion{}));
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_FALSE(told.has("publishes")) << told.now();
  }
  auto* const rival = peer.writer<fast::Twist>("rt/cmd_vel");
  ASSERT_NE(rival, nullptr);
  const std::string told =
      stderr_until("publishes /cmd_vel, too", [&] { EXPECT_TRUE(write(*effector, Motion{})); });
  EXPECT_NE(
      told.find("warning: robot.part.buffer: another program publishes /cmd_vel, too (1 until now; type "
                "geometry_msgs::msg::dds_::Twist_, participant 01.0f."),
      std::string::npos)
      << told;
  effector->close();
}

TEST_F(WithFastDds, WarnsOfASecondPublisherOfTheSameController) {
  const auto base = binding<Motion>("/twice", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega");
  auto first = opened_effector(base);
  auto second = opened_effector(base);
  const std::string told =
      stderr_until("publishes /twice, too", [&] { EXPECT_TRUE(write(*first, Motion{})); });
  EXPECT_NE(told.find("another driver of this controller publishes /twice, too"), std::string::npos) << told;
  first->close();
  second->close();
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
