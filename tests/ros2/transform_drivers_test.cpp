// Drivers of transforms against Fast DDS.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "bindings.hpp"
#include "eventually.hpp"
#include "fast_peer.hpp"
#include "ros2/tf/transform_value.hpp"
#include "stderr_text.hpp"
#include "tessera/fields.hpp"

namespace tessera::ros2 {
namespace {

struct PlanarPose {
  double x{}, y{}, yaw{};
  TESSERA_FIELDS(PlanarPose, x, y, yaw)
};
struct SentPose {
  double x{}, y{}, yaw{};
  bool known{};
  TESSERA_FIELDS(SentPose, x, y, yaw, known)
};
struct Quaternion {
  double x{}, y{}, z{}, w{};
  TESSERA_FIELDS(Quaternion, x, y, z, w)
};
struct Turn {
  Quaternion rotation{};
  std::int32_t sec{};
  TESSERA_FIELDS(Turn, rotation, sec)
};

struct Range {
  float range_max{};
  TESSERA_FIELDS(Range, range_max)
};

template <class Value>
Ros2Binding transform(const std::string& topic, const std::string& fields = "") {
  Ros2Binding made = binding<Value>(topic, "tf2_msgs/msg/TFMessage", fields);
  made.frame = "base_link";
  made.in = "map";
  return made;
}

fast::Transforms one(const std::string& parent, const std::string& child, std::int32_t sec, double x = 0,
                     double z = 0, double w = 1) {
  fast::Transforms made;
  made.all_transforms.push_back({{sec, 0, parent}, child, {x, 0, 0, 0, 0, z, w}});
  return made;
}

class TransformDrivers : public testing::Test {
 protected:
  fast::Peer peer{test_domain()};
};

TEST_F(TransformDrivers, GiveTheNewestPoseOfTwoPublishersAndEachOnce) {
  auto* const moving = peer.writer<fast::Transforms>("rt/tf");
  auto* const fixed = peer.writer<fast::Transforms>("rt/tf_static", true, "", /*transient_local=*/true);
  auto still = one("map", "odom", 0, 10, 1, 0);  // turned by half a turn
  fixed->write(&still);
  auto receptor = opened_receptor(transform<PlanarPose>("/tf"));
  PlanarPose pose{7, 7, 7};
  std::int32_t second = 0;
  ASSERT_TRUE(eventually([&] {
    ++second;
    auto message = one("odom", "base_link", second, second, std::sin(0.25), std::cos(0.25));
    moving->write(&message);
    return read(*receptor, pose);
  }));
  EXPECT_LE(pose.x, 9);
  EXPECT_EQ(pose.x, std::round(pose.x));
  auto message = one("odom", "base_link", ++second, 3, std::sin(0.25), std::cos(0.25));
  moving->write(&message);
  ASSERT_TRUE(eventually([&] { return read(*receptor, pose) && pose.x == 7; }));
  EXPECT_NEAR(pose.y, 0, 1e-12);
  EXPECT_NEAR(std::cos(pose.yaw), -std::cos(0.5), 1e-12);
  EXPECT_NEAR(std::sin(pose.yaw), -std::sin(0.5), 1e-12);
  pose.x = -1;
  EXPECT_FALSE(read(*receptor, pose));
  moving->write(&message);  // the same stamp again is nothing new
  message = one("odom", "other", second + 1);
  moving->write(&message);
  EXPECT_FALSE(read(*receptor, pose));
  EXPECT_EQ(pose.x, -1);
  receptor->close();
}

TEST_F(TransformDrivers, GiveThePoseAtTheStampsOfAnotherTopic) {
  auto* const moving = peer.writer<fast::Transforms>("rt/tf");
  auto* const laser = peer.writer<fast::LaserScan>("rt/scan");
  auto scans = binding<Range>("/scan", "sensor_msgs/msg/LaserScan");
  scans.path = "robot.part.scan";
  auto scan = opened_receptor(scans);
  auto at_scans = transform<PlanarPose>("/tf");
  at_scans.at = "scan";
  auto receptor = opened_receptor(at_scans);
  PlanarPose pose;
  Range range;
  fast::LaserScan seen;
  seen.header.sec = 50;
  seen.header.nanosec = 500'000'000;
  ASSERT_TRUE(eventually([&] {
    laser->write(&seen);
    return read(*scan, range);
  }));
  EXPECT_FALSE(read(*receptor, pose));  // there is none at that time until now
  std::int32_t sec = 40;
  ASSERT_TRUE(eventually([&] {
    auto message = one("map", "base_link", sec, sec);
    moving->write(&message);
    const bool is = read(*receptor, pose);
    if (sec < 51) ++sec;
    return is;
  }));
  EXPECT_EQ(pose.x, 50.5);
  EXPECT_FALSE(read(*receptor, pose));
  receptor->close();
  scan->close();
}

TEST_F(TransformDrivers, RefuseWhatIsWrongAndSayWhenTimeGoesBack) {
  auto* const moving = peer.writer<fast::Transforms>("rt/tf");
  auto receptor = opened_receptor(transform<PlanarPose>("/tf"));
  const StderrText told;
  PlanarPose pose;
  std::int32_t second = 1000;
  const auto send = [&](fast::Transforms message) { moving->write(&message); };
  ASSERT_TRUE(eventually([&] {
    send(one("map", "base_link", ++second, 1));
    return read(*receptor, pose);
  }));
  ASSERT_TRUE(eventually([&] {
    send(one("map", "base_link", ++second, 5, 0, 1.5));
    EXPECT_FALSE(read(*receptor, pose) && pose.x == 5);
    return told.has(
        "warning: /tf: the transform of `base_link` in `map` was refused: its rotation is no unit "
        "quaternion (1 until now)");
  }));
  ASSERT_TRUE(eventually([&] {
    send(one("map", "base_link", 3, 8));
    return read(*receptor, pose) && pose.x == 8;
  }));
  EXPECT_TRUE(told.has("warning: /tf: time has gone back by ")) << told.now();
  EXPECT_TRUE(told.has(" s, at `base_link`: transforms of before are forgotten (1 until now)")) << told.now();
  receptor->close();
}

TEST_F(TransformDrivers, BroadcastWhatIsKnownAmongOthers) {
  auto* const reader = peer.reader<fast::Transforms>("rt/tf");
  auto* const other = peer.writer<fast::Transforms>("rt/tf");
  auto effector = opened_effector(transform<SentPose>("/tf"));
  auto receptor = opened_receptor(transform<PlanarPose>("/tf"));
  const StderrText told;
  ASSERT_TRUE(eventually([&] { return fast::Peer::is_matched(*reader) && fast::Peer::is_matched(*other); }));
  ASSERT_TRUE(write(*effector, SentPose{}));  // a safe command
  std::optional<fast::Transforms> sent;
  ASSERT_TRUE(eventually([&] {
    EXPECT_TRUE(write(*effector, SentPose{1, 2, 0.5, true}));
    return (sent = fast::Peer::take<fast::Transforms>(*reader)).has_value();
  }));
  ASSERT_EQ(sent->all_transforms.size(), 1U);
  const fast::TransformStamped& first = sent->all_transforms[0];
  EXPECT_EQ(first.header.frame_id, "map");
  EXPECT_EQ(first.child, "base_link");
  EXPECT_GT(first.header.sec, 1'600'000'000);
  EXPECT_EQ(first.transform[0], 1);
  EXPECT_EQ(first.transform[1], 2);
  EXPECT_NEAR(first.transform[5], std::sin(0.25), 1e-12);
  EXPECT_NEAR(first.transform[6], std::cos(0.25), 1e-12);
  PlanarPose pose;
  EXPECT_TRUE(eventually([&] { return read(*receptor, pose); }));
  EXPECT_NEAR(pose.yaw, 0.5, 1e-12);
  EXPECT_THROW(static_cast<void>(write(*effector, SentPose{NAN, 0, 0, true})), std::runtime_error);
  EXPECT_FALSE(told.has("publishes /tf, too")) << told.now();
  effector->close();
  receptor->close();
}

TEST_F(TransformDrivers, BroadcastFixedTransformsWhenTheyChange) {
  auto effector = opened_effector(transform<Turn>("/tf_static", "rotation=rotation, stamp.sec=sec"));
  EXPECT_TRUE(write(*effector, Turn{}));
  EXPECT_TRUE(write(*effector, Turn{{0, 0, 0, 1}, 5}));
  EXPECT_TRUE(write(*effector, Turn{{0, 0, 1, 0}, 6}));
  EXPECT_TRUE(write(*effector, Turn{{0, 0, 1, 0}, 7}));
  EXPECT_THROW(static_cast<void>(write(*effector, Turn{{0, 0, 1, 1}, 8})), std::runtime_error);
  auto* const reader = peer.reader<fast::Transforms>("rt/tf_static", /*transient_local=*/true);  // comes late
  std::optional<fast::Transforms> sent;
  ASSERT_TRUE(eventually([&] { return (sent = fast::Peer::take<fast::Transforms>(*reader)).has_value(); }));
  EXPECT_EQ(sent->all_transforms.at(0).header.sec, 6);
  EXPECT_EQ(sent->all_transforms.at(0).transform[5], 1);
  EXPECT_TRUE(write(*effector, Turn{{0, 0, 0, 1}, 9}));
  ASSERT_TRUE(eventually([&] { return (sent = fast::Peer::take<fast::Transforms>(*reader)).has_value(); }));
  EXPECT_EQ(sent->all_transforms.at(0).header.sec, 9);
  effector->close();
}

}  // namespace
}  // namespace tessera::ros2
