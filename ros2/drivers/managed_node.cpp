#include "ros2/drivers/managed_node.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ros2/arguments/rules.hpp"
#include "ros2/drivers/server.hpp"
#include "ros2/lifecycle/messages.hpp"

namespace tessera::ros2 {
namespace {

// Devices may take long to open; a client that waits no longer gets nothing.
constexpr Duration longest_transition = std::chrono::hours(1);
constexpr int most_requests_at_once = 16;

class ServedLifecycle final : public ManagedNode {
 public:
  /// Throws std::runtime_error.
  explicit ServedLifecycle(const EndpointSetup& node)
      : setup_(node),
        events_(event_topic(), /*writes=*/true),
        change_(service("change_state", "lifecycle_msgs/srv/ChangeState")),
        state_(service("get_state", "lifecycle_msgs/srv/GetState")),
        states_(service("get_available_states", "lifecycle_msgs/srv/GetAvailableStates")),
        transitions_(service("get_available_transitions", "lifecycle_msgs/srv/GetAvailableTransitions")),
        graph_(service("get_transition_graph", "lifecycle_msgs/srv/GetAvailableTransitions")) {
    change_.use_timeout(longest_transition);
    for (ServiceServer* const server : all()) server->open();
  }
  /// The client that has ordered the end gets its answer.
  ~ServedLifecycle() override {
    change_.close();
    for (ServiceServer* const server : all())
      if (server != &change_) server->close(Duration::zero());
  }
  ServedLifecycle(const ServedLifecycle&) = delete;
  ServedLifecycle& operator=(const ServedLifecycle&) = delete;

  [[nodiscard]] std::string name() const override { return setup_.node; }

  [[nodiscard]] std::optional<LifecycleOrder> serve() override {
    answer(state_, [&] { return state_answer(life_.state()); });
    answer(states_, [] { return states_answer(lifecycle_states()); });
    answer(transitions_, [&] { return transitions_answer(life_.available()); });
    answer(graph_, [] { return transitions_answer(lifecycle_transitions()); });
    for (int requests = 0; requests < most_requests_at_once; ++requests) {
      const auto request = change_.next_request();
      if (!request) break;
      const auto change = read_change_request(request->message);
      if (!change) {
        change_.drop(request->number);
        continue;
      }
      const auto order = life_.request(change->id, change->label);
      publish_steps();
      if (order) {
        under_way_ = request->number;
        return order;
      }
      static_cast<void>(change_.reply(request->number, change_answer(false)));
    }
    return std::nullopt;
  }

  [[nodiscard]] bool begin(LifecycleOrder order) override {
    const bool fits = life_.begin(order);
    publish_steps();
    return fits;
  }

  void finish(LifecycleOutcome outcome) override {
    life_.finish(outcome);
    end_step(outcome == LifecycleOutcome::success);
  }

  void fail() override {
    life_.fail();
    end_step(false);
  }

 private:
  /// The event comes before the answer, so that a client that has its answer can have the event.
  void end_step(bool success) {
    publish_steps();
    if (const std::uint64_t number = std::exchange(under_way_, 0); number != 0)
      static_cast<void>(change_.reply(number, change_answer(success)));
  }

  void publish_steps() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const auto now_ns =
        static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
    for (const LifecycleTransition& step : life_.take_steps())
      static_cast<void>(events_.write(transition_event(now_ns, step)));
  }

  template <class Message>
  static void answer(ServiceServer& server, Message message) {
    for (int requests = 0; requests < most_requests_at_once; ++requests) {
      const auto request = server.next_request();
      if (!request) return;
      static_cast<void>(server.reply(request->number, message()));
    }
  }

  [[nodiscard]] EndpointSetup event_topic() const {
    EndpointSetup topic = setup_;
    topic.topic =
        rules_of_process().name(Rules::Kind::topic, "~/transition_event", node_name_in(setup_.node));
    topic.dds_topic = dds_topic_name(topic.topic);
    topic.dds_type = dds_type_name("lifecycle_msgs/msg/TransitionEvent");
    topic.qos = Qos{.depth = 10};
    return topic;
  }
  [[nodiscard]] ServiceSetup service(const char* name, const char* type) const {
    EndpointSetup endpoint = setup_;
    endpoint.topic =
        rules_of_process().name(Rules::Kind::service, std::string("~/") + name, node_name_in(setup_.node));
    return {.endpoint = endpoint, .type = type};
  }
  [[nodiscard]] std::array<ServiceServer*, 5> all() {
    return {&change_, &state_, &states_, &transitions_, &graph_};
  }

  const EndpointSetup setup_;
  Lifecycle life_;
  Endpoint events_;
  ServiceServer change_, state_, states_, transitions_, graph_;
  std::uint64_t under_way_ = 0;  ///< the request whose order is under way; 0: none
};

}  // namespace

std::unique_ptr<ManagedNode> make_managed_node(const ManagedNodeSetup& setup, std::string& error) {
  try {
    EndpointSetup node;
    node.path = setup.node;
    node.node = rules_of_process().node(setup.node).full();
    node.network = {.domain = setup.domain ? *setup.domain : domain_of_environment(),
                    .interface = setup.interface,
                    .peers = setup.peers};
    return std::make_unique<ServedLifecycle>(node);
  } catch (const std::exception& exception) {
    error = exception.what();
    return nullptr;
  }
}

}  // namespace tessera::ros2
