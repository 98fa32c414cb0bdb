#include "ros2/drivers/nodes.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "ros2/arguments/rules.hpp"
#include "ros2/dds/clock.hpp"
#include "ros2/drivers/server.hpp"
#include "ros2/parameters/node_parameters.hpp"

namespace tessera::ros2 {
namespace {

using Clock = std::chrono::steady_clock;

/// Requests wake the thread. Those that come by Fast DDS alone, and replies that wait for their client, do not.
constexpr auto look_for_requests = std::chrono::milliseconds(20);
constexpr auto look_for_changes = std::chrono::milliseconds(100);
constexpr auto between_diagnostics = std::chrono::seconds(1);
constexpr int kept_events = 1000;  // as rclcpp

/// Wakes the thread that serves.
class Wake {
 public:
  void request_came() { set(came_); }
  void end() { set(ends_); }
  /// Waits for a request, but no longer than this. Whether the end has come.
  [[nodiscard]] bool ends_within(Clock::duration time) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, time, [this] { return ends_ || came_; });
    came_ = false;
    return ends_;
  }

 private:
  void set(bool& what) {
    {
      const std::lock_guard lock(mutex_);
      what = true;
    }
    changed_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  bool came_ = false, ends_ = false;
};

/// The services and topics of one node.
class ServedNode {
 public:
  /// Throws std::runtime_error.
  ServedNode(Ros2Host& host, const Network& network, const std::string& node, std::set<std::string> agents,
             const std::shared_ptr<Wake>& wake)
      : node_(node),
        setup_(setup_of(network, node, *agents.begin())),
        parameters_(host, node, std::move(agents)),
        events_(topic("/parameter_events", "rcl_interfaces/msg/ParameterEvent", kept_events),
                /*writes=*/true),
        diagnostics_(topic("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", 10), /*writes=*/true) {
    for (const ParameterServiceName& one : parameter_services) {
      EndpointSetup endpoint = setup_;
      endpoint.topic =
          rules_of_process().name(Rules::Kind::service, std::string("~/") + one.name, node_name_in(node_));
      endpoint.on_message = [wake] { wake->request_came(); };
      servers_.push_back({one.service, std::make_unique<ServiceServer>(
                                           ServiceSetup{.endpoint = endpoint, .type = one.type})});
      servers_.back().server->open();
    }
  }
  /// The end of the run does not wait for clients, which may have been killed.
  ~ServedNode() {
    for (const Served& one : servers_) one.server->close(Duration::zero());
  }
  ServedNode(const ServedNode&) = delete;
  ServedNode& operator=(const ServedNode&) = delete;

  void serve_requests() {
    for (const Served& one : servers_) {
      for (int requests = 0; requests < most_at_once; ++requests) {
        const auto request = one.server->next_request();
        if (!request) break;
        if (auto answer = parameters_.answer(one.service, request->message))
          static_cast<void>(one.server->reply(request->number, *std::move(answer)));
        else
          one.server->drop(request->number);
      }
    }
  }

  /// If a message is lost, the next one is not.
  void tell_of_changes() {
    if (const auto event = parameters_.event(stamp_now())) static_cast<void>(events_.write(*event));
  }

  void publish(const std::vector<Ros2Status>& all, const std::string& system) {
    std::vector<Ros2Status> own;
    for (const Ros2Status& one : all)
      if (const auto name = parameters_.name_of(one.path)) {
        own.push_back(one);
        own.back().path = *name;
      }
    static_cast<void>(diagnostics_.write(diagnostics_message(stamp_now(), node_.substr(1), system, own)));
  }

 private:
  struct Served {
    ParameterService service;
    std::unique_ptr<ServiceServer> server;
  };
  static constexpr int most_at_once = 16;

  static EndpointSetup setup_of(const Network& network, const std::string& node, const std::string& agent) {
    EndpointSetup setup;
    setup.path = agent;
    setup.node = node;
    setup.network = network;
    return setup;
  }
  [[nodiscard]] EndpointSetup topic(const char* name, const char* type, int depth) const {
    EndpointSetup setup = setup_;
    setup.topic = rules_of_process().name(Rules::Kind::topic, name, node_name_in(node_));
    setup.dds_topic = dds_topic_name(setup.topic);
    setup.dds_type = dds_type_name(type);
    setup.qos = Qos{.depth = depth};
    return setup;
  }

  std::string node_;
  EndpointSetup setup_;
  NodeParameters parameters_;
  Endpoint events_, diagnostics_;
  std::vector<Served> servers_;
};

/// A thread of its own. Nothing waits for it, and a failure in it ends the serving and not the run.
class ServedNodes final : public Ros2Nodes {
 public:
  ServedNodes(Ros2Host& host, std::vector<std::unique_ptr<ServedNode>> nodes, std::shared_ptr<Wake> wake)
      : host_(host), nodes_(std::move(nodes)), wake_(std::move(wake)), thread_([this] { serve(); }) {}
  ~ServedNodes() override {
    wake_->end();
    thread_.join();
  }
  ServedNodes(const ServedNodes&) = delete;
  ServedNodes& operator=(const ServedNodes&) = delete;

 private:
  void serve() {
    try {
      serve_until_ended();
    } catch (const std::exception& exception) {
      std::fprintf(stderr, "warning: parameters and diagnostics for ROS 2 end: %s\n", exception.what());
    }
  }

  void serve_until_ended() {
    Clock::time_point changes_at = Clock::now(), diagnostics_at = changes_at;
    while (!wake_->ends_within(look_for_requests)) {
      for (const auto& node : nodes_) node->serve_requests();
      const Clock::time_point now = Clock::now();
      if (now >= changes_at) {
        changes_at = now + look_for_changes;
        for (const auto& node : nodes_) node->tell_of_changes();
      }
      if (now < diagnostics_at) continue;
      diagnostics_at = std::max(diagnostics_at + between_diagnostics, now);
      const std::vector<Ros2Status> statuses = host_.statuses();
      for (const auto& node : nodes_) node->publish(statuses, host_.system());
    }
  }

  Ros2Host& host_;
  std::vector<std::unique_ptr<ServedNode>> nodes_;
  std::shared_ptr<Wake> wake_;
  std::thread thread_;
};

/// The agents that the run has something to show of.
std::set<std::string> agents_of(Ros2Host& host) {
  std::set<std::string> agents;
  for (const Ros2Status& one : host.statuses()) agents.insert(one.path.substr(0, one.path.find('.')));
  return agents;
}

}  // namespace

std::unique_ptr<Ros2Nodes> make_nodes(Ros2Host& host, std::string& error) {
  error.clear();
  try {
    const std::set<std::string> known = agents_of(host);
    const auto wake = std::make_shared<Wake>();
    std::vector<std::unique_ptr<ServedNode>> nodes;
    for (const auto& participant : Participant::all())
      for (auto& [node, agents] : participant->nodes()) {
        std::erase_if(agents, [&](const std::string& agent) { return !known.contains(agent); });
        if (!agents.empty())
          nodes.push_back(
              std::make_unique<ServedNode>(host, participant->network(), node, std::move(agents), wake));
      }
    if (!nodes.empty()) return std::make_unique<ServedNodes>(host, std::move(nodes), wake);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return nullptr;
}

}  // namespace tessera::ros2
