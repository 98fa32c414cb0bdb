#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "bag/bag_inputs.hpp"
#include "mcap/writer.hpp"
#include "ros2/actions/messages.hpp"
#include "tessera/goal_life.hpp"
#include "tessera/recording.hpp"

/// The progress of goals, out of the topics of an action in a bag.
namespace tessera::bag::test {
namespace {

constexpr const char* line =
    "================================================================================\nMSG: ";

/// Feedback and result together, as the driver has them.
WantedInput wanted() {
  WantedInput input{{"robot.eyes.seen", "/go", "demo/action/Go",
                     std::string("Go_Feedback feedback\nGo_Result result\n") + line +
                         "demo/Go_Feedback\nfloat32 left\n" + line + "demo/Go_Result\nuint16 code\n",
                     "feedback.left=left,result.code=code", "", ""},
                    "{call: uint32, state: uint8, left: float32, code: uint16}",
                    /*is_action=*/true};
  return input;
}

ros2::GoalId id_of(std::uint8_t goal) {
  ros2::GoalId id{};
  id.fill(std::byte{goal});
  return id;
}

/// Writes the topics of the action as another program does.
class Topics {
 public:
  explicit Topics(const std::string& feedback_definition = {}) : writer_("ros2", "another program") {
    status_ = writer_.add_channel({0,
                                   writer_.add_schema("action_msgs/msg/GoalStatusArray", "ros2msg", ""),
                                   "/go/_action/status",
                                   "cdr",
                                   {}});
    feedback_ = writer_.add_channel(
        {0,
         writer_.add_schema("demo/action/Go_FeedbackMessage", feedback_definition.empty() ? "" : "ros2msg",
                            feedback_definition),
         "/go/_action/feedback",
         "cdr",
         {}});
  }
  using Goals = std::vector<std::pair<std::uint8_t, GoalState>>;
  void status(std::uint64_t at, const Goals& goals) {
    std::vector<ros2::GoalStatus> all;
    for (const auto& [goal, state] : goals)
      all.push_back({{id_of(goal), {}}, static_cast<std::int8_t>(state)});
    write(status_, at, ros2::status_message(all));
  }
  template <class Number>
  void feedback(std::uint64_t at, std::uint8_t goal, Number left) {
    std::vector<std::byte> message{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
    message.resize(4 + sizeof left);
    std::memcpy(message.data() + 4, &left, sizeof left);
    write(feedback_, at, ros2::with_goal_id(id_of(goal), message));
  }
  /// "1 ms: 2 executing 3.5 queued", a line for each value; the notes come last.
  std::string values() {
    writer_.finish();
    std::string error;
    const auto inputs = inputs_of(writer_.take(), "demo", {wanted()}, error);
    if (!inputs) return error;
    RecordingReader reader;
    reader.feed(inputs->recording);
    std::string text;
    for (const Recording::Entry& entry : reader.recording().entries) {
      const ValueEvent value = value_of(entry);
      std::uint32_t call = 0;
      float left = 0;
      std::memcpy(&call, value.bytes.data(), sizeof call);
      std::memcpy(&left, value.bytes.data() + 5, sizeof left);
      text += std::to_string(entry.event.time_ns) + ": " + std::to_string(call) + " " +
              std::string(goal_state_names[static_cast<std::uint8_t>(value.bytes[4])]) + " " +
              std::to_string(left).substr(0, 3) + (value.has(ValueFlags::queued) ? " queued\n" : "\n");
    }
    for (const std::string& note : inputs->notes) text += note + "\n";
    return text;
  }

 private:
  void write(std::uint16_t channel, std::uint64_t at, const std::vector<std::byte>& message) {
    writer_.write(channel, 1000 + at, 900 + at,
                  {reinterpret_cast<const char*>(message.data()), message.size()});
  }
  mcap::Writer writer_;
  std::uint16_t status_ = 0, feedback_ = 0;
};

constexpr const char* note =
    "robot.eyes.seen takes the 2 goals of /go for its calls 1 to 2; results and rejections are in no topic\n";

TEST(ActionFeed, GoalsOfTheBagAreTheCallsInTheirOrder) {
  using enum GoalState;
  Topics topics;
  topics.status(0, {{7, succeeded}});  // before the bag began
  topics.status(1, {{7, succeeded}, {1, accepted}});
  topics.status(2, {{7, succeeded}, {1, executing}});
  topics.feedback(3, 1, 2.5F);
  topics.feedback(4, 1, 1.5F);
  topics.status(5, {{1, succeeded}, {2, accepted}});
  topics.status(6, {{1, succeeded}, {2, executing}});
  topics.status(7, {{1, succeeded}, {2, canceling}});
  topics.status(8, {{1, succeeded}, {2, canceled}});
  EXPECT_EQ(topics.values(), std::string("1: 1 accepted 0.0 queued\n"
                                         "2: 1 executing 0.0 queued\n"
                                         "3: 1 executing 2.5\n"
                                         "4: 1 executing 1.5\n"
                                         "5: 1 succeeded 1.5 queued\n"
                                         "5: 2 accepted 0.0 queued\n"
                                         "6: 2 executing 0.0 queued\n"
                                         "7: 2 canceling 0.0 queued\n"
                                         "8: 2 canceled 0.0 queued\n") +
                                 note);
}

TEST(ActionFeed, TopicsMayBeOutOfStepAndWhatDoesNotBelongIsDropped) {
  using enum GoalState;
  Topics topics;
  topics.status(0, {{7, aborted}});
  topics.status(5, {{1, executing}});
  topics.feedback(4, 1, 9.F);                          // it stands behind, and was heard before
  topics.status(8, {{1, executing}, {2, executing}});  // preempted
  topics.status(9, {{1, canceled}, {2, executing}});
  topics.feedback(10, 1, 1.F);
  topics.feedback(11, 7, 1.F);
  topics.status(12, {{2, aborted}});
  topics.status(13, {{2, executing}});
  topics.feedback(14, 2, 1.F);
  EXPECT_EQ(topics.values(), std::string("4: 1 accepted 0.0 queued\n"
                                         "4: 1 executing 9.0 queued\n"
                                         "8: 2 accepted 0.0 queued\n"
                                         "8: 2 executing 0.0 queued\n"
                                         "12: 2 aborted 0.0 queued\n") +
                                 note);
}

TEST(ActionFeed, DefinitionOfTheBagComesFirst) {
  using enum GoalState;
  Topics topics(std::string("unique_identifier_msgs/UUID goal_id\nGo_Feedback feedback\n") + line +
                "unique_identifier_msgs/UUID\nuint8[16] uuid\n" + line +
                "demo/Go_Feedback\nuint32 more\nfloat32 left\n");
  topics.status(0, {{1, executing}});
  topics.feedback(1, 1, std::pair<std::uint32_t, float>{7, 4.5F});
  topics.feedback(2, 1, 1.F);  // of no such form
  topics.status(3, {{2, succeeded}});
  EXPECT_EQ(
      topics.values(),
      std::string(
          "0: 1 accepted 0.0 queued\n"
          "0: 1 executing 0.0 queued\n"
          "1: 1 executing 4.5\n"
          "3: 2 accepted 0.0 queued\n"
          "3: 2 succeeded 0.0 queued\n"
          "1 of 2 messages on /go/_action/feedback do not fit into robot.eyes.seen and are left out\n") +
          note);
}

}  // namespace
}  // namespace tessera::bag::test
