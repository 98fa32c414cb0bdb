// The patrol with a simulated server of /navigate_to_pose, in simulated time and without ROS 2.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tessera_testing.hpp"

namespace control = patrol::robot::control;
namespace legs = patrol::robot::legs;
using namespace std::chrono_literals;
using State = tessera::GoalState;
using Names = std::vector<std::string>;

namespace {

/// Each goal is executed for one second, and then ends; so does one that is to be cancelled, at once.
struct Server {
  State end = State::succeeded;  ///< what becomes of goals
  std::uint32_t call = 0;
  State state = State::none;
  tessera::Time since{};
  int goals = 0, cancelled = 0;

  void obey(const patrol::Goal& wanted, tessera::Time now) {
    const bool under_way = state == State::executing;
    if (wanted.call != call) {
      if (under_way) ++cancelled;
      call = wanted.call;
      state = call == 0 ? State::none : State::executing;
      since = now;
      goals += call == 0 ? 0 : 1;
    } else if (under_way && wanted.cancel) {
      state = State::canceled;
      ++cancelled;
    } else if (under_way && now - since > 1s) {
      state = end;
    }
  }
};

class Patrol : public testing::Test {
 protected:
  Patrol() {
    robot.observe<legs::Context>([this](auto& legs) {
      now = legs.context.now;
      if (at) at(now);
      server.obey(legs.out.wanted, now);
    });
    robot.sense<patrol::Progress>("robot.eyes.seen", [this]() -> std::optional<patrol::Progress> {
      return patrol::Progress{server.call, static_cast<std::uint8_t>(server.state), 0};
    });
    robot.sense<patrol::Battery>("robot.gauge.charge", [this] { return patrol::Battery{battery}; });
    robot.sense<patrol::Wish>("robot.panel.button", [this] { return patrol::Wish{pause}; });
  }

  tessera::SystemUnderTest robot{tessera::generated_system()};
  Server server;
  tessera::Time now{};
  float battery = 1;
  bool pause = false;
  std::function<void(tessera::Time)> at;
};

TEST_F(Patrol, GoesFromStationToStation) {
  ASSERT_FALSE(robot.run(8s).failed);
  const Names ran = robot.behaviours("robot.control");
  EXPECT_GE(std::ranges::count(ran, "next_station"), 4);
  EXPECT_EQ(Names(ran.begin(), ran.begin() + 4), (Names{"stand", "to_station", "next_station", "stand"}));
  EXPECT_EQ(server.cancelled, 0);
}

TEST_F(Patrol, OrdersALostGoalAgainAfterTwoSeconds) {
  server.end = State::aborted;
  at = [this](tessera::Time time) {
    if (time > tessera::Time(3s)) server.end = State::succeeded;
  };
  ASSERT_FALSE(robot.run(6s).failed);
  const Names ran = robot.behaviours("robot.control");
  EXPECT_EQ(Names(ran.begin(), ran.begin() + 6),
            (Names{"stand", "to_station", "recover", "stand", "to_station", "next_station"}));
}

TEST_F(Patrol, CancelsOnALowBatteryAndGoesToTheDock) {
  at = [this](tessera::Time time) {
    battery = time > tessera::Time(4s) ? 0.9F : time > tessera::Time(700ms) ? 0.1F : 1.0F;
  };
  ASSERT_FALSE(robot.run(6s).failed);
  const Names ran = robot.behaviours("robot.control");
  EXPECT_EQ(Names(ran.begin(), ran.begin() + 6),
            (Names{"stand", "to_station", "to_dock", "charge", "stand", "to_station"}));
  EXPECT_EQ(server.cancelled, 1);
}

TEST_F(Patrol, StandsWhileTheOperatorWantsIt) {
  at = [this](tessera::Time time) { pause = time > tessera::Time(700ms) && time < tessera::Time(3s); };
  ASSERT_FALSE(robot.run(3s).failed);
  EXPECT_EQ(robot.behaviours("robot.control"), (Names{"stand", "to_station", "stand"}));
  EXPECT_EQ(server.goals, 1);
  EXPECT_EQ(server.cancelled, 1);
  EXPECT_EQ(server.state, State::canceled);
}

TEST_F(Patrol, StandsWithoutABattery) {
  robot.sense<patrol::Battery>("robot.gauge.charge", []() -> std::optional<patrol::Battery> { return {}; });
  ASSERT_FALSE(robot.run(3s).failed);
  EXPECT_EQ(robot.behaviours("robot.control"), Names{"stand"});
  EXPECT_EQ(server.goals, 0);
}

// One iteration: what the memory of the goal says, and then the conditions of the specification.
TEST(ToStation, IsFollowedByRecoverAfterEveryLoss) {
  for (const State lost : {State::aborted, State::rejected, State::gone, State::canceled}) {
    tessera::SubsystemUnderTest<control::Context> subsystem;
    subsystem.receive(subsystem.in.battery, patrol::Battery{1});
    EXPECT_EQ(subsystem.iterate("to_station"), "to_station");
    subsystem.tell("going", lost);
    EXPECT_EQ(subsystem.iterate("to_station"), "recover");
  }
}

}  // namespace
