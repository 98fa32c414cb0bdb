// A participant of another implementation that uses all interfaces, the default for ROS 2 nodes.
#include "ros2/dds/other_side.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

#include "bindings.hpp"
#include "eventually.hpp"
#include "fast_peer.hpp"
#include "stderr_text.hpp"

namespace tessera::ros2 {
namespace {

using std::chrono::milliseconds;

TEST(OtherSideWatch, TellsOnceOfNobodyAndOfWhoComes) {
  EndpointSetup setup;
  setup.path = "robot.laser.scan";
  setup.topic = "/scan";
  setup.network = {.domain = 7, .interface = "eth0"};
  OtherSideWatch::Clock::time_point now{};
  std::atomic<bool> advised{false};
  const auto fits = [] { return false; };
  OtherSideWatch watch(setup, /*writes=*/false, now, advised);
  EXPECT_FALSE(watch.look(false, now += milliseconds(2900), fits));
  EXPECT_EQ(
      watch.look(false, now += milliseconds(200), fits),
      "robot.laser.scan: nobody publishes /scan on interface eth0 in domain 7: is ROS_DOMAIN_ID the same at "
      "the other side, and does the network carry multicast (else name `peers`)?");
  EXPECT_FALSE(watch.look(false, now += milliseconds(9000), fits));
  EXPECT_EQ(watch.look(true, now, fits),
            "robot.laser.scan: somebody publishes /scan on interface eth0 in domain 7");
  EXPECT_FALSE(watch.look(true, now, fits));
  EXPECT_FALSE(watch.look(false, now += milliseconds(9000), fits)) << "it has gone just now";
  EXPECT_EQ(watch.look(false, now += milliseconds(3100), fits),
            "robot.laser.scan: nobody publishes /scan on interface eth0 in domain 7 any more");
}

TEST(OtherSideWatch, AdvisesNothingIfTheOtherSideHasEnded) {
  EndpointSetup setup;
  setup.path = "robot.base.command";
  setup.topic = "/cmd_vel";
  OtherSideWatch::Clock::time_point now{};
  std::atomic<bool> advised{false};
  const auto fits = [] { return false; };
  OtherSideWatch watch(setup, /*writes=*/true, now, advised);
  EXPECT_FALSE(watch.look(true, now += milliseconds(100), fits));
  EXPECT_FALSE(watch.look(false, now += milliseconds(100), fits));
  EXPECT_EQ(watch.look(false, now += milliseconds(3100), fits),
            "robot.base.command: nobody subscribes to /cmd_vel on interface lo in domain 0 any more");
  EXPECT_FALSE(advised) << "another topic may need it";
}

TEST(OtherSideWatch, SaysNothingOfTheNetworkIfAnEndpointDoesNotFit) {
  OtherSideWatch::Clock::time_point now{};
  std::atomic<bool> advised{false};
  OtherSideWatch watch(EndpointSetup{}, /*writes=*/true, now, advised);
  EXPECT_FALSE(watch.look(false, now += milliseconds(3100), [] { return true; }));
  EXPECT_FALSE(advised) << "another topic may need it";
}

/// Runs it in a network of its own, with lo and one more interface (address 10.91.0.1). false: none can be made.
bool in_own_network(const std::function<void()>& what) {
  bool made = false;
  std::thread([&] {
    made =
        unshare(CLONE_NEWNET) == 0 &&
        std::system(
            "{ ip link set lo up && ip link add v0 type veth peer name v1 && "
            "ip addr add 10.91.0.1/24 dev v0 && ip link set v0 up && ip link set v1 up; } 2>/dev/null") == 0;
    if (made) what();
  }).join();
  return made;
}

TEST(OtherSide, OfADefaultParticipantIsToldAsMissingOnLoopbackAndFoundOnItsInterface) {
  const auto base = [](const std::string& interface, const std::string& peers = "") {
    auto made = binding<Motion>("/cmd_vel", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega");
    made.interface = interface;
    made.peers = peers;
    return made;
  };
  const bool made = in_own_network([&] {
    for (const char* peers : {"", "10.91.0.1"}) {  // found by multicast, and without it
      fast::Peer peer(test_domain(), fast::Reach::all);
      auto* const reader = peer.reader<fast::Twist>("rt/cmd_vel");
      auto effector = opened_effector(base("v0", peers));
      EXPECT_TRUE(eventually([&] {
        EXPECT_TRUE(write(*effector, Motion{1, 0}));
        return fast::Peer::take<fast::Twist>(*reader).has_value();
      })) << "peers: "
          << peers;
    }
    // A new one: the one before would still write to the ports of the drivers that it knew.
    fast::Peer peer(test_domain(), fast::Reach::all);
    peer.reader<fast::Twist>("rt/cmd_vel");
    const StderrText told;
    auto effector = opened_effector(base("lo"));
    EXPECT_TRUE(eventually([&] {
      EXPECT_TRUE(write(*effector, Motion{1, 0}));
      return told.has("nobody subscribes to /cmd_vel on interface lo");
    }));
    EXPECT_TRUE(told.has("Write `interface: v0` into the driver")) << told.now();
  });
  if (!made) GTEST_SKIP() << "no network namespace can be made here (root, package iproute2)";
}

}  // namespace
}  // namespace tessera::ros2
