// The life of a client's goals, without DDS.
#include "ros2/actions/goal_life.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace tessera::ros2 {
namespace {

using std::chrono::milliseconds;
using Kind = GoalLife::Deed::Kind;
using enum GoalState;

GoalId id_of(unsigned number) {
  GoalId id{};
  id[0] = static_cast<std::byte>(number);
  id[1] = static_cast<std::byte>(number >> 8);
  return id;
}
GoalLife::Bytes bytes(unsigned char one) { return {std::byte{one}}; }

/// A life whose goals have the names 1, 2, 3 ..., and a clock.
struct Life {
  Life() { life.hear_of_server(true, now); }
  void order(std::uint64_t call, bool cancel = false) { life.order(call, cancel, bytes(7), now); }
  void pass(milliseconds time) {
    now += time;
    life.hear_of_server(there, now);
  }
  std::vector<GoalState> states() {
    std::vector<GoalState> states;
    while (auto event = life.take_event()) {
      if (states.empty() || states.back() != event->state) states.push_back(event->state);
      last = std::move(*event);
    }
    return states;
  }
  std::vector<Kind> deeds() {
    std::vector<Kind> kinds;
    for (const GoalLife::Deed& deed : life.take_deeds()) {
      kinds.push_back(deed.kind);
      newest = deed.id;
    }
    return kinds;
  }
  void accept() {
    order(1);
    life.hear_answer(id_of(1), true, now);
    EXPECT_EQ(states(), (std::vector{ordered, accepted}));
    EXPECT_EQ(deeds(), (std::vector{Kind::send_goal, Kind::ask_result}));
  }
  void end(GoalState state, unsigned id = 1) {
    life.hear_result(id_of(id), static_cast<std::int8_t>(state), bytes(9), now);
  }

  unsigned names = 0;
  GoalLife life{[this] { return id_of(++names); }};
  GoalLife::Instant now{std::chrono::hours(1)};
  bool there = true;
  GoalLife::Event last;
  GoalId newest{};
};

TEST(GoalStates, ThatAReaderMayBeToldAreThoseOfSeveralSteps) {
  for (std::uint8_t from = 0; from < goal_state_count; ++from) {
    std::set<GoalState> reached{static_cast<GoalState>(from)};
    for (std::size_t before = 0; before != reached.size();) {
      before = reached.size();
      for (std::uint8_t to = 0; to < goal_state_count; ++to)
        for (const GoalState one : std::set<GoalState>(reached))
          // An order begins another life.
          if (static_cast<GoalState>(to) != ordered && may_follow(one, static_cast<GoalState>(to)))
            reached.insert(static_cast<GoalState>(to));
    }
    for (std::uint8_t to = 0; to < goal_state_count; ++to)
      EXPECT_EQ(can_follow(static_cast<GoalState>(from), static_cast<GoalState>(to)),
                reached.contains(static_cast<GoalState>(to)))
          << goal_state_names[from] << " and " << goal_state_names[to];
  }
}

TEST(GoalLife, SucceedsInItsOrder) {
  Life one;
  one.accept();
  one.life.hear_status(id_of(1), 2, one.now);
  one.life.hear_feedback(id_of(1), bytes(3));
  one.life.hear_feedback(id_of(1), bytes(4));
  EXPECT_EQ(one.states(), std::vector{executing});
  EXPECT_EQ(one.last.feedback, bytes(4));
  one.end(succeeded);
  EXPECT_EQ(one.states(), std::vector{succeeded});
  EXPECT_EQ(one.last.call, 1U);
  EXPECT_EQ(one.last.result, bytes(9));
  one.order(1);
  one.order(1, true);
  one.order(0);
  EXPECT_TRUE(one.deeds().empty()) << "the same call is ordered once, and an ended goal is not cancelled";
  EXPECT_TRUE(one.states().empty());
}

TEST(GoalLife, HasEveryTransition) {
  const auto after = [](auto... actions) {
    Life one;
    one.accept();
    (actions(one), ...);
    return one.states();
  };
  const auto status = [](std::int8_t code) {
    return [code](Life& one) { one.life.hear_status(id_of(1), code, one.now); };
  };
  const auto end = [](GoalState state) { return [state](Life& one) { one.end(state); }; };
  const auto vanish = [](Life& one) {
    one.there = false;
    one.pass(milliseconds(1));
  };
  for (const GoalState state : {succeeded, canceled, aborted}) {
    EXPECT_EQ(after(end(state)), std::vector{state});
    EXPECT_EQ(after(status(2), end(state)), (std::vector{executing, state}));
    EXPECT_EQ(after(status(2), status(3), end(state)), (std::vector{executing, canceling, state}));
    EXPECT_EQ(after(status(3), status(2), status(1), end(state)), (std::vector{canceling, state}));
  }
  EXPECT_EQ(after(vanish), std::vector{gone});
  EXPECT_EQ(after(status(2), vanish), (std::vector{executing, gone}));
  EXPECT_EQ(after(status(3), vanish), (std::vector{canceling, gone}));
  Life refused;
  refused.order(5);
  refused.life.hear_answer(id_of(1), false, refused.now);
  EXPECT_EQ(refused.states(), (std::vector{ordered, rejected}));
  EXPECT_FALSE(refused.life.is_busy());
}

TEST(GoalLife, WithoutAServerIsNotSent) {
  Life one;
  one.there = false;
  one.pass(milliseconds(0));
  one.order(1);
  one.pass(milliseconds(1999));
  EXPECT_EQ(one.states(), std::vector{ordered});
  one.pass(milliseconds(1));
  EXPECT_EQ(one.states(), std::vector{gone});
  one.there = true;
  one.pass(milliseconds(1));
  EXPECT_TRUE(one.deeds().empty()) << "an old order is never sent late";
  EXPECT_EQ(one.life.counts().unserved, 1U);
}

TEST(GoalLife, OrderThatIsWithdrawnBeforeItIsSentIsNotSent) {
  Life one;
  one.there = false;
  one.pass(milliseconds(0));
  one.order(1);
  one.order(0);
  one.there = true;
  one.pass(milliseconds(1));
  EXPECT_TRUE(one.deeds().empty());
  EXPECT_EQ(one.states(), (std::vector{ordered, gone}));
}

TEST(GoalLife, OfAServerThatIsSilentEndsInTime) {
  Life one;
  one.accept();
  milliseconds passed{0};
  for (; one.life.state() != gone && passed < std::chrono::minutes(1); passed += milliseconds(10))
    one.pass(milliseconds(10));
  EXPECT_LE(passed, milliseconds(2000));
  EXPECT_EQ(one.life.counts().lost, 1U);
  // One that answers lives on.
  Life other;
  other.accept();
  for (passed = milliseconds(0); passed < std::chrono::minutes(1); passed += milliseconds(10)) {
    other.pass(milliseconds(10));
    for (const Kind kind : other.deeds())
      if (kind == Kind::probe) other.life.hear_sign_of_life();
  }
  EXPECT_EQ(other.life.state(), accepted);
}

TEST(GoalLife, IsCancelledOnce) {
  Life one;
  one.accept();
  one.order(1, true);
  one.order(1, true);
  one.order(1, false);
  EXPECT_EQ(one.deeds(), std::vector{Kind::cancel});
  one.life.hear_of_cancel(id_of(1), CancelCode::good, one.now);
  EXPECT_EQ(one.states(), std::vector{canceling});
  one.end(canceled);
  EXPECT_EQ(one.states(), std::vector{canceled});
}

TEST(GoalLife, CancelBeforeTheAnswerComesAfterIt) {
  Life one;
  one.order(1);
  one.order(0);
  EXPECT_EQ(one.deeds(), std::vector{Kind::send_goal});
  one.life.hear_answer(id_of(1), true, one.now);
  EXPECT_EQ(one.deeds(), (std::vector{Kind::ask_result, Kind::cancel}));
  one.pass(milliseconds(2000));
  EXPECT_EQ(one.states(), (std::vector{ordered, accepted, gone})) << "a cancel without an answer";
  EXPECT_EQ(one.life.counts().unanswered, 1U);
}

TEST(GoalLife, CancelThatIsRefusedLeavesTheGoal) {
  Life one;
  one.accept();
  one.order(1, true);
  one.life.hear_of_cancel(id_of(1), CancelCode::refused, one.now);
  EXPECT_EQ(one.life.state(), accepted);
  EXPECT_EQ(one.life.counts().uncancelled, 1U);
  one.end(succeeded);
  EXPECT_EQ(one.states(), std::vector{succeeded});
  Life other;
  other.accept();
  other.order(0);
  other.life.hear_of_cancel(id_of(1), CancelCode::unknown_goal, other.now);
  EXPECT_EQ(other.states(), std::vector{gone});
}

TEST(GoalLife, NewOneCancelsTheOldOneOfWhichNothingIsHeardAnyMore) {
  Life one;
  one.accept();
  one.order(2);
  EXPECT_EQ(one.deeds(), (std::vector{Kind::cancel, Kind::send_goal}));
  one.life.hear_status(id_of(1), 3, one.now);
  one.life.hear_feedback(id_of(1), bytes(1));
  one.end(canceled);
  EXPECT_EQ(one.states(), std::vector{ordered});
  EXPECT_EQ(one.last.call, 2U);
  EXPECT_EQ(one.life.counts().given_up, 3U);
  // One whose answer has not come is cancelled when it comes.
  one.order(3);
  EXPECT_EQ(one.deeds(), std::vector{Kind::send_goal});
  one.life.hear_answer(id_of(2), true, one.now);
  EXPECT_EQ(one.deeds(), std::vector{Kind::cancel});
  EXPECT_EQ(one.newest, id_of(2));
  one.life.hear_answer(id_of(3), true, one.now);
  EXPECT_EQ(one.states(), (std::vector{ordered, accepted}));
}

TEST(GoalLife, GoalThatIsAcceptedTooLateIsCancelled) {
  Life one;
  one.order(1);
  one.pass(milliseconds(2000));
  EXPECT_EQ(one.states(), (std::vector{ordered, gone}));
  static_cast<void>(one.deeds());
  one.life.hear_answer(id_of(1), true, one.now);
  EXPECT_EQ(one.deeds(), std::vector{Kind::cancel});
  EXPECT_EQ(one.life.counts().late_acceptance, 1U);
  EXPECT_TRUE(one.states().empty());
}

TEST(GoalLife, GoalThatIsAcceptedAgainAfterItsEndIsCancelled) {
  Life one;
  one.accept();
  one.end(succeeded);
  EXPECT_EQ(one.states(), std::vector{succeeded});
  static_cast<void>(one.deeds());
  one.life.hear_answer(id_of(1), true, one.now);
  EXPECT_EQ(one.deeds(), std::vector{Kind::cancel});
  EXPECT_EQ(one.life.counts().repeated, 1U);
  EXPECT_TRUE(one.states().empty());
  one.order(2);
  static_cast<void>(one.deeds());
  one.life.hear_answer(id_of(1), true, one.now);
  EXPECT_EQ(one.deeds(), std::vector{Kind::cancel}) << "a goal long ago";
  one.life.hear_answer(id_of(2), true, one.now);
  EXPECT_EQ(one.states(), (std::vector{ordered, accepted}));
  one.life.hear_answer(id_of(2), true, one.now);
  EXPECT_EQ(one.deeds(), std::vector{Kind::ask_result}) << "a second server is no reason to cancel";
}

TEST(GoalLife, GoalOfAServerThatComesBackIsCancelled) {
  Life one;
  one.accept();
  one.there = false;
  one.pass(milliseconds(1));
  EXPECT_EQ(one.states(), std::vector{gone});
  one.there = true;
  one.pass(milliseconds(1));
  EXPECT_TRUE(one.deeds().empty());
  one.life.hear_status(id_of(1), 2, one.now);
  one.life.hear_status(id_of(1), 2, one.now);
  EXPECT_EQ(one.deeds(), std::vector{Kind::cancel});
  EXPECT_TRUE(one.states().empty());
}

TEST(GoalLife, WrongOrdersOfTheServerAreDroppedAndCounted) {
  Life one;
  one.order(1);
  one.end(succeeded);
  EXPECT_EQ(one.life.counts().disorder, 1U) << "a result before acceptance";
  one.life.hear_status(id_of(9), 4, one.now);
  one.end(succeeded, 9);
  one.life.hear_feedback(id_of(9), bytes(1));
  EXPECT_EQ(one.life.counts().unknown, 3U) << "of a goal that is none of ours";
  one.life.hear_answer(id_of(1), true, one.now);
  one.life.hear_answer(id_of(1), false, one.now);
  EXPECT_EQ(one.life.counts().disorder, 2U) << "a second answer";
  one.end(aborted);
  one.end(succeeded);
  one.life.hear_feedback(id_of(1), bytes(1));
  EXPECT_EQ(one.life.counts().disorder, 4U) << "a second result, feedback after the end";
  one.life.hear_status(id_of(1), 2, one.now);
  EXPECT_EQ(one.states(), (std::vector{ordered, accepted, aborted}));
}

TEST(GoalLife, WordsBeforeTheAcceptanceCountAfterIt) {
  Life one;
  one.order(1);
  one.life.hear_feedback(id_of(1), bytes(5));
  one.life.hear_status(id_of(1), 2, one.now);
  EXPECT_EQ(one.states(), std::vector{ordered});
  one.life.hear_answer(id_of(1), true, one.now);
  EXPECT_EQ(one.states(), (std::vector{accepted, executing}));
  EXPECT_EQ(one.last.feedback, bytes(5));
  EXPECT_EQ(one.life.counts().disorder, 0U);
}

TEST(GoalLife, EndWithoutItsResultIsGone) {
  Life one;
  one.accept();
  one.life.hear_status(id_of(1), 4, one.now);
  one.life.hear_sign_of_life();
  EXPECT_TRUE(one.states().empty()) << "the result tells the end";
  for (int time = 0; time < 20; ++time) {
    one.pass(milliseconds(100));
    one.life.hear_sign_of_life();
  }
  EXPECT_EQ(one.states(), std::vector{gone});
  for (const std::optional<std::int8_t> status : {std::optional<std::int8_t>{}, {0}, {2}, {7}, {-1}}) {
    Life other;
    other.accept();
    other.life.hear_result(id_of(1), status, bytes(1), other.now);
    EXPECT_EQ(other.states(), std::vector{gone});
    EXPECT_EQ(other.life.counts().unreadable, 1U);
  }
}

/// Says anything in any order, and looks whether the life is one.
class Chaos {
 public:
  explicit Chaos(unsigned seed) : random_(seed) {}

  void run() {
    for (int step = 0; step < 60; ++step) {
      act();
      look(/*reads=*/draw(3) > 0);
    }
    look(/*reads=*/true);
  }
  [[nodiscard]] const std::set<std::pair<GoalState, GoalState>>& transitions() const { return transitions_; }

 private:
  unsigned draw(unsigned below) { return static_cast<unsigned>(random_() % below); }

  void act() {
    GoalLife& life = one_.life;
    const GoalId id = id_of(draw(4) > 0 ? one_.names : draw(one_.names + 2));
    switch (draw(12)) {
      case 0:
        return one_.order(call_ += draw(2), draw(8) == 0);
      case 1:
        return one_.order(draw(3) == 0 ? 0 : call_, draw(6) == 0);
      case 2:
      case 3:
        return life.hear_answer(id, draw(8) > 0, one_.now);
      case 4:
        return life.hear_result(id, static_cast<std::int8_t>(draw(9)), bytes(1), one_.now);
      case 5:
      case 6:
        return life.hear_status(id, static_cast<std::int8_t>(draw(9)), one_.now);
      case 7:
        return life.hear_feedback(id, bytes(2));
      case 8:
        return life.hear_of_cancel(id, static_cast<CancelCode>(draw(5)), one_.now);
      case 9:
        one_.there = draw(8) > 0;
        return one_.pass(milliseconds(draw(700)));
      default:
        life.hear_sign_of_life();
        return one_.pass(milliseconds(draw(50)));
    }
  }

  /// reads: the receptor is read now.
  void look(bool reads) {
    for (const GoalLife::Deed& deed : one_.life.take_deeds())
      if (deed.kind == Kind::send_goal) {
        EXPECT_TRUE(sent_.insert(deed.id).second) << "commanded twice";
        EXPECT_EQ(deed.goal, bytes(7));
        EXPECT_EQ(deed.id, id_of(one_.names)) << "an old goal";
      }
    if (!reads) return;
    while (const auto event = one_.life.take_event()) {
      if (event->call != seen_call_) {
        EXPECT_GT(event->call, seen_call_);
        seen_ = none;
      }
      seen_call_ = event->call;
      EXPECT_TRUE(event->state == seen_ || may_follow(seen_, event->state))
          << static_cast<int>(seen_) << " -> " << static_cast<int>(event->state);
      EXPECT_FALSE(is_end(seen_) && event->state == seen_) << "an end was told twice";
      EXPECT_EQ(event->result.empty(), !(event->state >= succeeded && event->state <= aborted));
      transitions_.emplace(seen_, event->state);
      seen_ = event->state;
    }
    if (one_.life.state() != none) {
      EXPECT_EQ(seen_, one_.life.state()) << "a state was lost";
    }
  }

  std::mt19937 random_;
  Life one_;
  std::uint64_t call_ = 0, seen_call_ = 0;
  GoalState seen_ = none;
  std::set<GoalId> sent_;
  std::set<std::pair<GoalState, GoalState>> transitions_;
};

TEST(GoalLife, IsALifeInAnyOrder) {
  std::set<std::pair<GoalState, GoalState>> all;
  for (unsigned seed = 0; seed < 10'000 && !testing::Test::HasFailure(); ++seed) {
    Chaos chaos(seed);
    chaos.run();
    all.insert(chaos.transitions().begin(), chaos.transitions().end());
  }
  for (int before = 0; before <= 9; ++before)
    for (int after = 0; after <= 9; ++after) {
      const auto one = static_cast<GoalState>(before), other = static_cast<GoalState>(after);
      if (one != other) {
        EXPECT_EQ(all.contains({one, other}), may_follow(one, other)) << before << " -> " << after;
      }
    }
}

}  // namespace
}  // namespace tessera::ros2
