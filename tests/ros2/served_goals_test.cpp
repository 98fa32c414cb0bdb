// The goals of a server of an action, and the messages of actions, without DDS.
#include "ros2/actions/served_goals.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <random>
#include <vector>

#include "ros2/actions/messages.hpp"
#include "ros2/codec/value_type.hpp"
#include "ros2/codec/written_mapping.hpp"
#include "ros2/definitions/resolver.hpp"

namespace tessera::ros2 {
namespace {

using DeedKind = ServedGoals::Deed::Kind;
using enum GoalState;

GoalId named(unsigned char number) {
  GoalId id{};
  id[0] = static_cast<std::byte>(number);
  return id;
}

/// A result of a message without fields.
MessageBytes result_of(GoalState state) {
  return {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}, static_cast<std::byte>(state),
          std::byte{0}};
}

struct Served {
  Served() { goals.use_empty_result(result_of(none)); }
  void ask(unsigned char id) { goals.hear_goal(++question, named(id), {std::byte{id}}, at, now); }
  std::uint64_t give() {
    const auto event = goals.take_event();
    EXPECT_TRUE(event && !event->cancel);
    return event ? event->number : 0;
  }
  void say(std::uint64_t number, GoalState state) {
    goals.say(number, state, MessageBytes{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}},
              result_of(state), at, now);
  }
  CancelCode cancel(const GoalId& id, Stamp stamp = {}) {
    goals.hear_cancel(++question, {id, stamp});
    for (const auto& deed : goals.take_deeds())
      if (deed.kind == DeedKind::answer_cancel)
        return read_cancel_answer(deed.message).value_or(static_cast<CancelCode>(-1));
    return static_cast<CancelCode>(-1);
  }
  /// Answers and states since the last look: "yes", "no", "result 4", "states 2 4".
  std::string deeds() {
    std::string all;
    for (const auto& deed : goals.take_deeds()) {
      all += all.empty() ? "" : ", ";
      if (deed.kind == DeedKind::answer_goal) all += *read_goal_answer(deed.message) ? "yes" : "no";
      if (deed.kind == DeedKind::answer_result)
        all += "result " + std::to_string(*read_result_status(deed.message));
      if (deed.kind == DeedKind::answer_cancel) all += "cancel";
      if (deed.kind == DeedKind::feedback) all += "feedback";
      if (deed.kind != DeedKind::status) continue;
      all += "states";
      const auto states = read_status(deed.message);
      for (const GoalStatus& one : *states) all += " " + std::to_string(one.status);
    }
    return all;
  }

  ServedGoals goals;
  ServedGoals::Question question = 0;
  Stamp at{5, 0};
  ServedGoals::Instant now{std::chrono::hours(1)};
};

TEST(ServedGoals, AreGivenOneAfterTheOtherAndRunTogether) {
  Served one;
  one.ask(1);
  one.ask(2);
  EXPECT_EQ(one.give(), 1U);
  EXPECT_FALSE(one.goals.take_event()) << "the first is undecided";
  one.say(1, executing);
  EXPECT_EQ(one.deeds(), "yes, states 1, states 2, feedback");
  one.say(1, executing);
  EXPECT_EQ(one.deeds(), "") << "the same may be said again";
  EXPECT_EQ(one.give(), 2U);
  one.say(2, accepted);
  EXPECT_EQ(one.deeds(), "yes, states 2 1");
  one.goals.hear_result_question(++one.question, named(1));
  one.say(1, succeeded);
  EXPECT_EQ(one.deeds(), "result 4, states 4 1");
  one.goals.hear_result_question(++one.question, named(1));
  one.goals.hear_result_question(++one.question, named(9));
  EXPECT_EQ(one.deeds(), "result 4, result 0");
  one.say(2, aborted);
  EXPECT_EQ(one.deeds(), "states 4 2, states 4 6") << "a value that ends a goal has no feedback";
  one.say(2, executing);
  one.say(7, accepted);
  EXPECT_EQ(one.goals.counts().useless, 2U);
}

TEST(ServedGoals, AreRejectedAndForgotten) {
  Served one;
  one.ask(1);
  one.ask(1);
  EXPECT_EQ(one.deeds(), "no") << "another goal has its name";
  one.say(one.give(), rejected);
  EXPECT_EQ(one.deeds(), "no");
  EXPECT_EQ(one.cancel(named(1)), CancelCode::unknown_goal);
  one.ask(2);
  one.now += std::chrono::seconds(10);
  one.goals.tick(one.at, one.now);
  EXPECT_EQ(one.deeds(), "no");
  EXPECT_EQ(one.goals.counts().undecided, 1U);
  for (unsigned char id = 10; id < 10 + ServedGoals::most_open; ++id) one.ask(id);
  EXPECT_EQ(one.deeds(), "");
  one.ask(99);
  EXPECT_EQ(one.deeds(), "no");
  EXPECT_EQ(one.goals.counts().crowded, 1U);
}

TEST(ServedGoals, AreCancelledByNameByTimeOrAll) {
  Served one;
  for (unsigned char id = 1; id <= 3; ++id) {
    one.at.sec = id;
    one.ask(id);
    one.say(one.give(), executing);
  }
  static_cast<void>(one.deeds());
  EXPECT_EQ(one.cancel(named(8)), CancelCode::unknown_goal);
  EXPECT_EQ(one.cancel(named(2)), CancelCode::good);
  auto event = one.goals.take_event();
  ASSERT_TRUE(event && event->cancel);
  EXPECT_EQ(event->number, 2U);
  EXPECT_FALSE(one.goals.take_event()) << "told once";
  one.say(2, canceled);
  EXPECT_EQ(one.cancel(named(2)), CancelCode::goal_has_ended);
  EXPECT_EQ(one.cancel({}, Stamp{1, 0}), CancelCode::good);
  event = one.goals.take_event();
  ASSERT_TRUE(event && event->cancel);
  EXPECT_EQ(event->number, 1U);
  EXPECT_FALSE(one.goals.take_event());
  EXPECT_EQ(one.cancel({}), CancelCode::good);
  EXPECT_TRUE(one.goals.take_event());
  one.say(3, succeeded);  // it may end otherwise
  EXPECT_EQ(one.deeds(), "states 3 5 4");
  Served deaf;
  deaf.goals.refuse_cancels();
  deaf.ask(1);
  deaf.say(deaf.give(), accepted);
  static_cast<void>(deaf.deeds());
  EXPECT_EQ(deaf.cancel(named(1)), CancelCode::refused);
  deaf.say(1, canceled);
  EXPECT_EQ(deaf.deeds(), "states 2, states 6") << "nobody had asked for it";
  EXPECT_EQ(deaf.goals.counts().uncancelled, 1U);
}

TEST(ServedGoals, EndWithTheServer) {
  Served one;
  one.ask(1);
  one.ask(2);
  one.say(one.give(), executing);
  one.goals.hear_result_question(++one.question, named(1));
  static_cast<void>(one.deeds());
  one.goals.end_all(one.at, one.now);
  EXPECT_EQ(one.deeds(), "result 6, states 6, no");
}

TEST(ServedGoals, KeepResultsForATime) {
  Served one;
  for (unsigned char id = 1; id <= ServedGoals::most_ended + 10; ++id) {
    one.ask(id);
    one.say(one.give(), succeeded);
    EXPECT_NE(one.deeds().find("yes"), std::string::npos);
  }
  one.goals.hear_result_question(++one.question, named(1));
  EXPECT_EQ(one.deeds(), "result 0") << "too many";
  one.goals.hear_result_question(++one.question, named(ServedGoals::most_ended));
  EXPECT_EQ(one.deeds(), "result 4");
  one.now += ServedGoals::keeps_results;
  one.goals.tick(one.at, one.now);
  one.goals.hear_result_question(++one.question, named(ServedGoals::most_ended));
  EXPECT_EQ(one.deeds(), "result 0");
}

ProgressType navigation() {
  const DefinitionFolders folders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"});
  std::vector<Mistake> mistakes;
  return ProgressType(resolve_action("nav2_msgs/action/NavigateToPose", folders, mistakes)->progress);
}

TEST(ActionMessages, AreJoinedAndSplitWithTheirAlignment) {
  const ProgressType type = navigation();
  auto empty = type.join({}, {});
  ASSERT_TRUE(empty);
  auto parts = type.split(*empty, 4);
  ASSERT_TRUE(parts);
  EXPECT_EQ(parts->result, type.empty_result(4));
  EXPECT_EQ(read_result_status(parts->result), std::int8_t{4});
  // The code of the result stands behind a state of one byte, so that it is aligned otherwise.
  parts->result[6] = std::byte{0x34};
  parts->result[7] = std::byte{0x12};
  const auto joined = type.join(parts->feedback, parts->result);
  ASSERT_TRUE(joined);
  const auto again = type.split(*joined, 4);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->result, parts->result);
  EXPECT_EQ(again->feedback, parts->feedback);
}

TEST(ActionMessages, HaveTheFrameOfTheDriverInTheirHeaders) {
  const DefinitionFolders folders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"});
  std::vector<Mistake> mistakes;
  const auto goal = resolve_action("nav2_msgs/action/NavigateToPose", folders, mistakes)->goal;
  std::vector<MappingProblem> problems;
  const auto sent =
      Translator::make(goal, *parse_value_type("{x: float64}"),
                       written_mapping("pose.pose.position.x=x", "", "map"), Direction::send, problems);
  const auto received = Translator::make(
      goal, *parse_value_type("{frame: string(8), sec: int32, w: float64}"),
      written_mapping("pose.header.frame_id=frame, pose.header.stamp.sec=sec, pose.pose.orientation.w=w", "",
                      ""),
      Direction::receive, problems);
  ASSERT_TRUE(sent && received) << problems.front().text;
  MessageBytes message, value;
  ASSERT_TRUE(sent->encode(MessageBytes(8), {77, 5}, message));
  ASSERT_EQ(received->decode(message, value), Translator::Outcome::good);
  ASSERT_EQ(value.size(), 4 + 3 + 4 + 8U);
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(value.data()) + 4, 3), "map");
  EXPECT_EQ(value[7], std::byte{0}) << "no time: the newest transformation counts";
  EXPECT_EQ(value.back(), std::byte{0x3f}) << "an orientation that is none would be refused";
}

/// Nothing that comes from the network may do harm.
TEST(ActionMessages, OfAnyBytesAreReadOrRefused) {
  const ProgressType type = navigation();
  const auto empty = type.split(*type.join({}, {}), 4);
  const std::vector<MessageBytes> seeds{empty->feedback,
                                        empty->result,
                                        goal_answer(true, {}),
                                        result_request(named(1)),
                                        cancel_request({}),
                                        cancel_answer(CancelCode::good, std::vector<GoalInfo>(2)),
                                        status_message(std::vector<GoalStatus>(3))};
  std::mt19937 random(7);
  std::size_t read = 0;
  for (int round = 0; round < 20'000; ++round) {
    MessageBytes message = seeds[random() % seeds.size()];
    for (auto changes = random() % 4; changes > 0 && !message.empty(); --changes) {
      if (random() % 4 == 0) message.resize(random() % (message.size() + 4));
      if (!message.empty()) message[random() % message.size()] = static_cast<std::byte>(random());
    }
    read += static_cast<std::size_t>(split_goal_id(message).has_value());
    read += static_cast<std::size_t>(read_goal_answer(message).has_value());
    read += static_cast<std::size_t>(read_result_request(message).has_value());
    read += static_cast<std::size_t>(read_result_status(message).has_value());
    read += static_cast<std::size_t>(read_cancel_request(message).has_value());
    read += static_cast<std::size_t>(read_cancel_answer(message).has_value());
    read += static_cast<std::size_t>(read_status(message).has_value());
    read += static_cast<std::size_t>(type.join(message, {}).has_value());
    read += static_cast<std::size_t>(type.join({}, message).has_value());
    read += static_cast<std::size_t>(type.split(message, 1).has_value());
  }
  EXPECT_GT(read, 20'000U);
}

}  // namespace
}  // namespace tessera::ros2
