// Clients and servers of actions against Fast DDS, whose types are written by hand, and against each other.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "attempts.hpp"
#include "eventually.hpp"
#include "fast_action.hpp"
#include "ros2/actions/goal.hpp"
#include "ros2/definitions/resolver.hpp"
#include "ros2/drivers/action_client.hpp"
#include "ros2/drivers/drivers.hpp"
#include "stderr_text.hpp"
#include "tessera/bounded_sequence.hpp"
#include "tessera/fields.hpp"

namespace tessera::ros2 {
namespace {

struct Order {
  std::uint32_t call{};
  bool cancel{};
  std::int32_t order{};
  TESSERA_FIELDS(Order, call, cancel, order)
};
struct Life {
  std::uint8_t state{};
  std::uint32_t call{};
  BoundedSequence<std::int32_t, 4> soFar{}, all{};
  TESSERA_FIELDS(Life, state, call, soFar, all)
};

/// Not that of the other tests, which run in the same process.
std::uint32_t action_domain() { return 60 + static_cast<std::uint32_t>(getpid() + 40) % 150; }

Ros2Binding side_of_action(const std::string& role, bool goal) {
  const std::string type = "action_tutorials_interfaces/action/Fibonacci";
  std::vector<Mistake> mistakes;
  const DefinitionFolders folders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"});
  const auto action = resolve_action(type, folders, mistakes);
  Ros2Binding made;
  made.path = "robot." + role + ".buffer";
  made.topic = "/fibonacci";
  made.type = type;
  made.role = role;
  made.definition = bundle_of(goal ? *action->goal : *action->progress);
  if (!goal) made.fields = "feedback.partial_sequence=soFar, result.sequence=all";
  made.interface = "lo";
  made.domain = action_domain();
  made.encoding = goal ? value_encoding_of<Order>() : value_encoding_of<Life>();
  return made;
}

template <class Driver, class Make>
std::unique_ptr<Driver> opened_action(Make make, const Ros2Binding& binding) {
  std::string error;
  std::unique_ptr<Driver> driver = make(binding, error);
  if (driver == nullptr) throw std::runtime_error(error);
  EXPECT_TRUE(driver->open());
  return driver;
}

std::vector<std::int32_t> numbers_in(const BoundedSequence<std::int32_t, 4>& numbers) {
  return {numbers.begin(), numbers.end()};
}

/// The two drivers of a client.
struct GoalClient {
  explicit GoalClient(Duration timeout = std::chrono::seconds(30), Duration wait = Duration::zero(),
                      const std::string& agent = "robot") {
    Ros2Binding sends = side_of_action("client", true), receives = side_of_action("client", false);
    sends.timeout = timeout;
    sends.wait = wait;
    sends.path = agent + ".legs.goal";
    receives.path = agent + ".eyes.progress";
    orders = opened_action<RealEffector>(make_effector, sends);
    lives = opened_action<RealReceptor>(make_receptor, receives);
  }
  ~GoalClient() {
    lives->close();
    orders->close();
  }
  bool order(std::uint32_t call, std::int32_t order, bool cancel = false) {
    newest = {call, cancel, order};
    return orders->write(std::as_bytes(std::span(&newest, 1)));
  }
  /// As a controller does, writes the same again and again.
  bool read() {
    EXPECT_TRUE(orders->write(std::as_bytes(std::span(&newest, 1))));
    return lives->read(std::as_writable_bytes(std::span(&life, 1)));
  }
  /// Reads until that state comes, and gives all that came.
  std::vector<GoalState> states_until(GoalState state) {
    std::vector<GoalState> states;
    EXPECT_TRUE(eventually([&] {
      while (read()) {
        if (states.empty() || states.back() != static_cast<GoalState>(life.state))
          states.push_back(static_cast<GoalState>(life.state));
        if (states.back() == state) return true;
      }
      return false;
    }));
    return states;
  }
  std::unique_ptr<RealEffector> orders;
  std::unique_ptr<RealReceptor> lives;
  Order newest;
  Life life;
};

struct GoalServer {
  explicit GoalServer(Duration timeout = std::chrono::seconds(30)) {
    Ros2Binding says = side_of_action("server", false);
    says.timeout = timeout;
    lives = opened_action<RealEffector>(make_effector, says);
    orders = opened_action<RealReceptor>(make_receptor, side_of_action("server", true));
  }
  ~GoalServer() {
    orders->close();
    lives->close();
  }
  bool read() { return orders->read(std::as_writable_bytes(std::span(&order, 1))); }
  bool say(std::uint32_t call, GoalState state, std::vector<std::int32_t> so_far = {},
           std::vector<std::int32_t> all = {}) {
    Life value{static_cast<std::uint8_t>(state), call, {}, {}};
    for (const std::int32_t one : so_far) value.soFar.push_back(one);
    for (const std::int32_t one : all) value.all.push_back(one);
    return lives->write(std::as_bytes(std::span(&value, 1)));
  }
  std::unique_ptr<RealReceptor> orders;
  std::unique_ptr<RealEffector> lives;
  Order order;
};

/// A server of Fast DDS that does only what a test says.
class FastActionServer {
 public:
  using Reader = eprosima::fastdds::dds::DataReader;
  using Writer = eprosima::fastdds::dds::DataWriter;

  explicit FastActionServer(fast::Peer& peer)
      : goals_(peer.reader<fast::SendGoalRequest>("rq" + name + "send_goalRequest", false, id(1))),
        answers_(peer.writer<fast::SendGoalResponse>("rr" + name + "send_goalReply", true, id(1))),
        questions_(peer.reader<fast::GetResultRequest>("rq" + name + "get_resultRequest", false, id(2))),
        results_(peer.writer<fast::GetResultResponse>("rr" + name + "get_resultReply", true, id(2))),
        cancels_(peer.reader<fast::CancelGoalRequest>("rq" + name + "cancel_goalRequest", false, id(3))),
        cancelled_(peer.writer<fast::CancelGoalResponse>("rr" + name + "cancel_goalReply", true, id(3))),
        feedback_(peer.writer<fast::Feedback>("rt" + name + "feedback")),
        states_(peer.writer<fast::StatusArray>("rt" + name + "status", true, "", /*transient_local=*/true)) {}

  /// Orders goals with new numbers until the server gets one: a request is lost if it is sent before the server
  /// has found the client, though the client has found the server.
  fast::SendGoalRequest first_goal(GoalClient& client, std::uint32_t& call) {
    std::optional<fast::SendGoalRequest> got;
    EXPECT_TRUE(eventually([&] {
      if (!matched(*answers_) || !matched(*goals_) || !matched(*questions_) || !matched(*results_) ||
          !matched(*cancels_) || !matched(*cancelled_) || !matched(*feedback_) || !matched(*states_))
        return false;
      EXPECT_TRUE(client.order(++call, 7));
      const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
      while (!got && std::chrono::steady_clock::now() < until) {
        EXPECT_TRUE(client.order(call, 7));
        got = fast::Peer::take<fast::SendGoalRequest>(*goals_);
      }
      return got.has_value();
    }));
    return got.value_or(fast::SendGoalRequest{});
  }
  void answer(const fast::SendGoalRequest& goal, bool accepted) {
    fast::SendGoalResponse reply{goal.client, goal.sequence, accepted};
    answers_->write(&reply);
  }
  /// Takes the question for the result; questions for other goals get the answer of a server.
  fast::GetResultRequest question(GoalClient& client, const fast::Uuid& goal) {
    std::optional<fast::GetResultRequest> found;
    EXPECT_TRUE(eventually([&] {
      static_cast<void>(client.orders->write(std::as_bytes(std::span(&client.newest, 1))));
      auto one = fast::Peer::take<fast::GetResultRequest>(*questions_);
      if (one && one->uuid == goal) found = one;
      return found.has_value();
    }));
    return found.value_or(fast::GetResultRequest{});
  }
  void result(const fast::GetResultRequest& question, std::int8_t status, std::vector<std::int32_t> numbers) {
    fast::GetResultResponse reply{question.client, question.sequence, status, std::move(numbers)};
    results_->write(&reply);
  }
  void state(const fast::Uuid& goal, std::int8_t status) {
    fast::StatusArray all;
    all.goals.push_back({fast::Uuid{1, 2, 3}, 1, 2, 4});  // of another client
    all.goals.push_back({goal, 0, 0, status});
    states_->write(&all);
  }
  void feedback(const fast::Uuid& goal, std::vector<std::int32_t> numbers) {
    fast::Feedback message{goal, std::move(numbers)};
    feedback_->write(&message);
  }
  std::optional<fast::CancelGoalRequest> take_cancel() {
    return fast::Peer::take<fast::CancelGoalRequest>(*cancels_);
  }
  void answer(const fast::CancelGoalRequest& cancel, std::int8_t code) {
    fast::CancelGoalResponse reply{cancel.client, cancel.sequence, code, cancel.uuid};
    cancelled_->write(&reply);
  }

 private:
  template <class Entity>
  static bool matched(Entity& entity) {
    return fast::Peer::is_matched(entity);
  }
  static std::string id(int number) { return "serviceid=01.0f." + std::to_string(number) + ";"; }
  const std::string name = "/fibonacci/_action/";
  Reader* goals_;
  Writer* answers_;
  Reader* questions_;
  Writer* results_;
  Reader* cancels_;
  Writer* cancelled_;
  Writer* feedback_;
  Writer* states_;
};

using enum GoalState;
using States = std::vector<GoalState>;

TEST(Actions, ClientFollowsAGoalToItsEnd) {
  fast::Peer peer(action_domain());
  GoalClient client;
  FastActionServer server(peer);
  std::uint32_t call = 0;
  const fast::SendGoalRequest goal = server.first_goal(client, call);
  EXPECT_EQ(goal.order, 7);
  EXPECT_EQ(client.states_until(ordered), States{ordered});
  EXPECT_EQ(client.life.call, call) << "nothing of goals that were given up";
  server.answer(goal, true);
  EXPECT_EQ(client.states_until(accepted), States{accepted});
  server.state(goal.uuid, 2);
  EXPECT_EQ(client.states_until(executing), States{executing});
  server.feedback(fast::Uuid{9}, {1});
  server.feedback(goal.uuid, {0, 1, 1, 2, 3});  // too long for the buffer
  server.feedback(goal.uuid, {0, 1});
  EXPECT_TRUE(eventually([&] { return client.read() && client.life.soFar.size() == 2; }));
  const fast::GetResultRequest question = server.question(client, goal.uuid);
  server.result(question, 4, {0, 1, 1});
  server.result(question, 6, {});
  EXPECT_EQ(client.states_until(succeeded), States{succeeded});
  EXPECT_EQ(numbers_in(client.life.all), (std::vector{0, 1, 1}));
  EXPECT_EQ(numbers_in(client.life.soFar), (std::vector{0, 1}));
  // The same number is the same goal. The next one is refused, and the one after it is aborted.
  ASSERT_TRUE(client.order(call, 8));
  ASSERT_TRUE(client.order(0, 8));
  const fast::SendGoalRequest next = server.first_goal(client, call);
  EXPECT_EQ(next.sequence, goal.sequence + 1);
  EXPECT_NE(next.uuid, goal.uuid);
  server.answer(next, false);
  EXPECT_EQ(client.states_until(rejected), (States{ordered, rejected}));
  const fast::SendGoalRequest last = server.first_goal(client, call);
  server.answer(last, true);
  server.result(server.question(client, last.uuid), 6, {0, 1, 1, 2, 3, 5});
  EXPECT_EQ(client.states_until(gone), (States{ordered, accepted, gone})) << "a result that does not fit";
}

TEST(Actions, ClientCancelsAndGivesUp) {
  fast::Peer peer(action_domain());
  std::optional<GoalClient> client(std::in_place);
  FastActionServer server(peer);
  std::uint32_t call = 0;
  const fast::SendGoalRequest first = server.first_goal(*client, call);
  server.answer(first, true);
  EXPECT_EQ(client->states_until(accepted), (States{ordered, accepted}));
  // A new number cancels the goal before it.
  const fast::SendGoalRequest second = server.first_goal(*client, call);
  std::optional<fast::CancelGoalRequest> cancel;
  ASSERT_TRUE(eventually([&] { return (cancel = server.take_cancel()).has_value(); }));
  EXPECT_EQ(cancel->uuid, first.uuid);
  EXPECT_EQ(cancel->sec, 0);
  EXPECT_EQ(cancel->nanosec, 0U);
  server.answer(*cancel, 0);
  server.answer(second, true);
  EXPECT_EQ(client->states_until(accepted), (States{ordered, accepted}));
  ASSERT_TRUE(client->order(call, 7, /*cancel=*/true));
  ASSERT_TRUE(eventually([&] { return (cancel = server.take_cancel()).has_value(); }));
  EXPECT_EQ(cancel->uuid, second.uuid);
  server.answer(*cancel, 0);
  EXPECT_EQ(client->states_until(canceling), States{canceling});
  server.result(server.question(*client, second.uuid), 5, {});
  EXPECT_EQ(client->states_until(canceled), States{canceled});
  EXPECT_FALSE(server.take_cancel().has_value()) << "a cancel is asked for once";
  // The end of a run cancels.
  const fast::SendGoalRequest third = server.first_goal(*client, call);
  server.answer(third, true);
  EXPECT_EQ(client->states_until(accepted), (States{ordered, accepted}));
  client.reset();
  ASSERT_TRUE(eventually([&] { return (cancel = server.take_cancel()).has_value(); }));
  EXPECT_EQ(cancel->uuid, third.uuid);
}

TEST(Actions, ClientLearnsThatItsServerHasGone) {
  GoalClient client;
  std::uint32_t call = 0;
  {
    fast::Peer peer(action_domain());
    FastActionServer server(peer);
    const fast::SendGoalRequest goal = server.first_goal(client, call);
    server.answer(goal, true);
    EXPECT_EQ(client.states_until(accepted), (States{ordered, accepted}));
  }
  EXPECT_EQ(client.states_until(gone), States{gone});
}

TEST(Actions, GoalWithoutAServerIsGoneInTime) {
  GoalClient client(std::chrono::milliseconds(20));
  ASSERT_TRUE(client.order(5, 1));
  EXPECT_EQ(client.states_until(gone), (States{ordered, gone}));
  EXPECT_EQ(client.life.call, 5U);
  EXPECT_FALSE(client.read());
}

TEST(Actions, ServerServesAClientOfFastDds) {
  fast::Peer peer(action_domain());
  GoalServer server;
  const std::string name = "/fibonacci/_action/", id = "clientid=01.0f.7;";
  auto* const goals = peer.writer<fast::SendGoalRequest>("rq" + name + "send_goalRequest", true, id);
  auto* const answers = peer.reader<fast::SendGoalResponse>("rr" + name + "send_goalReply", false, id);
  auto* const questions = peer.writer<fast::GetResultRequest>("rq" + name + "get_resultRequest", true, id);
  auto* const results = peer.reader<fast::GetResultResponse>("rr" + name + "get_resultReply", false, id);
  auto* const cancels = peer.writer<fast::CancelGoalRequest>("rq" + name + "cancel_goalRequest", true, id);
  auto* const cancelled = peer.reader<fast::CancelGoalResponse>("rr" + name + "cancel_goalReply", false, id);
  auto* const feedback = peer.reader<fast::Feedback>("rt" + name + "feedback");
  auto* const states = peer.reader<fast::StatusArray>("rt" + name + "status", /*transient_local=*/true);
  ASSERT_TRUE(eventually([&] {
    return fast::Peer::is_matched(*goals) && fast::Peer::is_matched(*answers) &&
           fast::Peer::is_matched(*questions) && fast::Peer::is_matched(*results) &&
           fast::Peer::is_matched(*cancels) && fast::Peer::is_matched(*cancelled) &&
           fast::Peer::is_matched(*feedback) && fast::Peer::is_matched(*states);
  }));
  fast::SendGoalRequest goal{77, 0, {5, 6, 7}, 11};
  ASSERT_TRUE(eventually([&] {
    ++goal.sequence;
    ++goal.uuid[15];
    goals->write(&goal);
    return server.read();
  }));
  EXPECT_EQ(server.order.order, 11);
  EXPECT_FALSE(server.order.cancel);
  const std::uint32_t call = server.order.call;
  std::optional<fast::SendGoalResponse> answer;
  ASSERT_TRUE(eventually([&] {
    EXPECT_TRUE(server.say(call, executing, {0, 1}));
    return (answer = fast::Peer::take<fast::SendGoalResponse>(*answers)).has_value();
  }));
  EXPECT_TRUE(answer->accepted);
  EXPECT_EQ(answer->client, 77U);
  const auto uuid = [&] {
    std::optional<fast::StatusArray> all;
    fast::GoalStatus newest;
    EXPECT_TRUE(eventually([&] {
      while ((all = fast::Peer::take<fast::StatusArray>(*states)))
        if (!all->goals.empty()) newest = all->goals.front();
      return newest.status == 2;
    }));
    return newest.uuid;
  }();
  EXPECT_EQ(uuid[0], 5);
  std::optional<fast::Feedback> told;
  std::int32_t number = 2;
  ASSERT_TRUE(eventually([&] {  // the writer may not have found the reader yet
    EXPECT_TRUE(server.say(call, executing, {0, 1, ++number}));
    return (told = fast::Peer::take<fast::Feedback>(*feedback)).has_value();
  }));
  EXPECT_EQ(told->uuid, uuid);
  fast::GetResultRequest question{77, 90, uuid};
  questions->write(&question);
  fast::CancelGoalRequest cancel{77, 91, uuid};
  cancels->write(&cancel);
  ASSERT_TRUE(eventually([&] {
    while (server.read())
      if (server.order.cancel && server.order.call == call) return true;
    return false;
  }));
  std::optional<fast::CancelGoalResponse> yes;
  ASSERT_TRUE(eventually([&] {
    EXPECT_TRUE(server.say(call, executing, {0, 1, number}));
    return (yes = fast::Peer::take<fast::CancelGoalResponse>(*cancelled)).has_value();
  }));
  EXPECT_EQ(yes->code, 0);
  EXPECT_EQ(yes->uuid, uuid);
  std::optional<fast::GetResultResponse> result;
  ASSERT_TRUE(eventually([&] {
    EXPECT_TRUE(server.say(call, canceled, {0, 1, number}, {8, 9}));
    return (result = fast::Peer::take<fast::GetResultResponse>(*results)).has_value();
  }));
  EXPECT_EQ(result->sequence, 90);
  EXPECT_EQ(result->status, 5);
  EXPECT_EQ(result->numbers, (std::vector<std::int32_t>{8, 9}));
  // A question for a goal that nobody has ordered.
  question = {77, 92, fast::Uuid{42}};
  questions->write(&question);
  ASSERT_TRUE(eventually([&] {
    EXPECT_FALSE(server.read() && server.order.cancel);
    return (result = fast::Peer::take<fast::GetResultResponse>(*results)).has_value();
  }));
  EXPECT_EQ(result->status, 0);
}

TEST(Actions, OfTwoControllersFindEachOther) {
  std::optional<GoalServer> server(std::in_place);
  GoalClient client(std::chrono::seconds(30), /*wait=*/std::chrono::seconds(60));
  std::uint32_t number = 0, call = 0;
  const auto order = [&] {
    const std::uint32_t before = call;
    // A goal that comes late is one that a newer order has replaced.
    EXPECT_TRUE(attempted([&] { ++number; },
                          [&] {
                            const auto wanted = static_cast<std::int32_t>(number);
                            EXPECT_TRUE(client.order(number, wanted));
                            return server->read() && !server->order.cancel && server->order.order == wanted;
                          }));
    call = server->order.call;
    EXPECT_GT(call, before);
  };
  order();
  ASSERT_TRUE(server->say(call, executing, {1}));
  EXPECT_EQ(client.states_until(executing).back(), executing);
  ASSERT_TRUE(server->say(call, succeeded, {1, 2}, {3}));
  EXPECT_EQ(client.states_until(succeeded).back(), succeeded);
  EXPECT_EQ(numbers_in(client.life.all), std::vector{3});
  order();
  ASSERT_TRUE(server->say(call, rejected));
  EXPECT_EQ(client.states_until(rejected), (States{ordered, rejected}));
  // The safe command cancels.
  order();
  ASSERT_TRUE(server->say(call, accepted));
  EXPECT_EQ(client.states_until(accepted), (States{ordered, accepted}));
  ASSERT_TRUE(client.order(0, 0));
  ASSERT_TRUE(eventually([&] { return server->read() && server->order.cancel; }));
  EXPECT_EQ(server->order.call, call);
  EXPECT_EQ(client.states_until(canceling).back(), canceling);
  ASSERT_TRUE(server->say(call, canceled));
  EXPECT_EQ(client.states_until(canceled).back(), canceled);
  // A server that ends aborts its goals.
  order();
  ASSERT_TRUE(server->say(call, executing));
  EXPECT_EQ(client.states_until(executing).back(), executing);
  server.reset();
  EXPECT_EQ(client.states_until(aborted).back(), aborted);
}

/// As the guardian process does after the death of a controller.
TEST(Actions, GoalsOfARunAreCancelledByTheirNamesAndNoOthers) {
  GoalServer server;
  GoalClient client(std::chrono::seconds(30), std::chrono::seconds(60));
  GoalClient other(std::chrono::seconds(30), std::chrono::seconds(60), "cart");
  for (GoalClient* const one : {&client, &other}) {
    std::uint32_t number = 0;
    ASSERT_TRUE(attempted([&] { ++number; },
                          [&] {
                            EXPECT_TRUE(one->order(number, one == &client ? 1 : 2));
                            return server.read() && !server.order.cancel;
                          }));
    ASSERT_TRUE(server.say(server.order.call, executing));
    EXPECT_EQ(one->states_until(executing).back(), executing);
  }
  EndpointSetup endpoint;
  endpoint.path = "guardian";
  endpoint.topic = "/fibonacci";
  endpoint.node = "/guardian";
  endpoint.network = {action_domain(), "lo", ""};
  ActionClient guardian({endpoint, "action_tutorials_interfaces/action/Fibonacci", true, {}, "action"});
  guardian.open();
  const GoalPrefix names = goal_prefix(getpid(), "robot.legs.goal /fibonacci");
  auto cancelled = std::async(std::launch::async,
                              [&] { return guardian.cancel_goals_of(names, std::chrono::seconds(60)); });
  ASSERT_TRUE(eventually([&] { return server.read() && server.order.cancel; }));
  EXPECT_EQ(server.order.order, 1);
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(server.read() && server.order.cancel) << "the goal of another";
    return cancelled.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }));
  EXPECT_TRUE(cancelled.get());
  EXPECT_TRUE(guardian.cancel_goals_of(names, std::chrono::seconds(60))) << "nothing is left";
  guardian.close();
}

}  // namespace
}  // namespace tessera::ros2
