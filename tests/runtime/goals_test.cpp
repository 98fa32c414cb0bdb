// A subsystem is told of its goals: every pair of states, wrong orders, orders and cancels.
#include "subsystem/goals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "system/clock.hpp"

namespace tessera {
namespace {

struct OrderedGoal {
  std::uint32_t call = 0;
  bool cancel = false;
};
struct ToldGoal {
  std::uint32_t call = 0;
  std::uint8_t state = 0;
};

/// The steps of the life, one by one: whatever follows is reached by them.
std::set<std::pair<GoalState, GoalState>> reached_by_steps() {
  using enum GoalState;
  std::set<std::pair<GoalState, GoalState>> all{
      {ordered, accepted},   {ordered, rejected},    {ordered, gone},      {accepted, executing},
      {accepted, canceling}, {accepted, succeeded},  {accepted, canceled}, {accepted, aborted},
      {accepted, gone},      {executing, canceling}, {executing, gone},    {executing, succeeded},
      {executing, canceled}, {executing, aborted},   {canceling, gone},    {canceling, succeeded},
      {canceling, canceled}, {canceling, aborted}};
  for (std::uint8_t state = 0; state < goal_state_count; ++state)
    all.emplace(GoalState{state}, GoalState{state});
  for (std::size_t before = 0; before != all.size();) {
    before = all.size();
    const auto known = all;
    for (const auto& [from, over] : known)
      for (const auto& [again, to] : known)
        if (over == again) all.emplace(from, to);
  }
  return all;
}

/// One goal behind one port, which behaviours 1 and 2 order; leaving 1 cancels it.
class OneGoal {
 public:
  OneGoal() : goals_(parts(), reports_) {}

  void begin(std::uint16_t behaviour, bool sends = true) {
    goals_.begin(behaviour);
    if (behaviour != 0) goals_.learn(0, static_cast<std::uint16_t>(GoalState::ordered));
    goals_.write();
    if (sends) goals_.note_sent(&payload(out_));
  }
  GoalState told(std::uint32_t call, std::uint8_t state, bool taken = true) {
    payload(in_) = {call, state};
    const std::uint16_t after = goals_.told(0, taken);
    goals_.learn(0, after);
    return static_cast<GoalState>(after);
  }
  void set(GoalState state) { goals_.learn(0, static_cast<std::uint16_t>(state)); }
  [[nodiscard]] const OrderedGoal& out() const { return out_; }
  [[nodiscard]] std::uint64_t dropped() const { return goals_.dropped(); }

 private:
  const SubsystemParts& parts() {
    net_.facts = facts_;
    instance_.net = &net_;
    parts_.instance = &instance_;
    parts_.path = "robot.control";
    parts_.bindings.input("progress", in_);
    parts_.bindings.output("goal", out_);
    parts_.bindings.goals.push_back(bound_goal("going", out_, in_, {{1, true}, {2, false}}));
    parts_.ports.push_back({.side = Side::receive});
    return parts_;
  }

  Input<ToldGoal> in_;
  Output<OrderedGoal> out_;
  std::array<Fact, 1> facts_{{{Fact::Kind::memory, "memory.going"}}};
  SubsystemNet net_{};
  Instance instance_{};
  SubsystemParts parts_{};
  RunControl control_{1};
  SimulatedClock clock_;
  Reports reports_{parts_, control_, clock_, nullptr};
  Goals goals_;
};

TEST(GoalLife, IsWhatItsStepsReach) {
  const auto reached = reached_by_steps();
  for (std::uint8_t before = 0; before < goal_state_count; ++before)
    for (std::uint8_t after = 0; after < goal_state_count; ++after)
      EXPECT_EQ(can_follow(GoalState{before}, GoalState{after}),
                reached.contains({GoalState{before}, GoalState{after}}))
          << goal_state_names.at(before) << " " << goal_state_names.at(after);
}

TEST(Goals, AreToldEveryStateOfTheLifeAndNoOther) {
  const auto reached = reached_by_steps();
  for (std::uint8_t before = 0; before < goal_state_count; ++before)
    for (unsigned after = 0; after < 256; ++after) {
      OneGoal goal;
      goal.begin(1);
      goal.set(GoalState{before});
      const auto state = static_cast<std::uint8_t>(after);
      const bool allowed = reached.contains({GoalState{before}, static_cast<GoalState>(state)});
      EXPECT_EQ(goal.told(1, state), allowed ? static_cast<GoalState>(state) : GoalState{before});
      EXPECT_EQ(goal.dropped(), allowed ? 0U : 1U);
    }
}

TEST(Goals, DoNotListenToOthers) {
  OneGoal goal;
  EXPECT_EQ(goal.told(0, 0), GoalState::none);
  EXPECT_EQ(goal.dropped(), 0U) << "nothing was ordered, and nothing is told";
  goal.begin(2);
  goal.begin(2);
  EXPECT_EQ(goal.told(1, 4), GoalState::ordered);
  EXPECT_EQ(goal.told(0, 0), GoalState::ordered);
  EXPECT_EQ(goal.dropped(), 0U) << "of an earlier goal: it was on its way";
  EXPECT_EQ(goal.told(3, 4), GoalState::ordered);
  EXPECT_EQ(goal.dropped(), 1U) << "of a goal that was not ordered";
  EXPECT_EQ(goal.told(2, 4, /*taken=*/false), GoalState::ordered);
  EXPECT_EQ(goal.told(2, 1), GoalState::accepted);
}

TEST(Goals, AreCancelledWhenTheirBehaviourIsLeftUnlessTheyHaveEnded) {
  OneGoal goal;
  goal.begin(0);
  EXPECT_EQ(goal.out().call, 0U);
  EXPECT_FALSE(goal.out().cancel);
  goal.begin(1);
  EXPECT_EQ(goal.out().call, 1U);
  EXPECT_FALSE(goal.out().cancel);
  static_cast<void>(goal.told(1, 2));
  goal.begin(0);
  EXPECT_TRUE(goal.out().cancel);
  static_cast<void>(goal.told(1, 5));
  goal.begin(0);
  EXPECT_TRUE(goal.out().cancel) << "until the next order";
  goal.begin(1);
  EXPECT_EQ(goal.out().call, 2U);
  EXPECT_FALSE(goal.out().cancel);
  static_cast<void>(goal.told(2, 4));
  goal.begin(0);
  EXPECT_FALSE(goal.out().cancel) << "it has ended";
  goal.begin(2);
  goal.begin(0);
  EXPECT_EQ(goal.out().call, 3U);
  EXPECT_FALSE(goal.out().cancel) << "that behaviour does not say cancel: on_leave";
  goal.begin(1);
  goal.begin(1);
  EXPECT_EQ(goal.out().call, 5U) << "left for itself: another goal";
  EXPECT_FALSE(goal.out().cancel);
}

TEST(Goals, AreWithdrawnIfTheirOrderHasNotGoneOut) {
  OneGoal goal;
  goal.begin(1);
  static_cast<void>(goal.told(1, 2));
  goal.begin(1, /*sends=*/false);
  EXPECT_EQ(goal.out().call, 2U);
  goal.begin(0);
  EXPECT_EQ(goal.out().call, 0U) << "which orders nothing";
  EXPECT_FALSE(goal.out().cancel);
  EXPECT_EQ(goal.told(1, 5), GoalState::gone);
  EXPECT_EQ(goal.told(1, 5), GoalState::gone);
  EXPECT_EQ(goal.dropped(), 0U);
  goal.begin(2);
  EXPECT_EQ(goal.out().call, 3U) << "a number is never used twice";
  EXPECT_EQ(goal.told(3, 4), GoalState::succeeded);
}

/// The state is always one that the life has after the one before, whatever comes.
TEST(Goals, StayOnTheLifeInAnyOrderOfValues) {
  std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same each time
  const auto reached = reached_by_steps();
  OneGoal goal;
  GoalState now = GoalState::none;
  for (int step = 0; step < 20'000; ++step) {
    if (random() % 30 == 0) {
      goal.begin(static_cast<std::uint16_t>(1 + random() % 2));
      now = GoalState::ordered;
    }
    const std::uint32_t call =
        goal.out().call + (random() % 8 == 0 ? static_cast<std::uint32_t>(random() % 3) - 1U : 0U);
    const GoalState after = goal.told(call, static_cast<std::uint8_t>(random() % 12), random() % 5 != 0);
    EXPECT_TRUE(reached.contains({now, after}));
    now = after;
  }
  EXPECT_GT(goal.dropped(), 1000U);
}

}  // namespace
}  // namespace tessera
