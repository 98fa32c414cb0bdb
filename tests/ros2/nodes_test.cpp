// The parameters and diagnostics of a node, as programs of ROS 2 see them over DDS.
#include "ros2/drivers/nodes.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "eventually.hpp"
#include "fast_peer.hpp"
#include "ros2/arguments/rules.hpp"

namespace tessera::ros2 {
namespace {

using eprosima::fastcdr::Cdr;

/// rcl_interfaces/msg/Parameter, written by hand.
struct WireParameter {
  std::string name;
  std::uint8_t type = 3;
  bool flag = false;
  std::int64_t whole = 0;
  double real = 0;
  std::string text;
  std::vector<std::uint8_t> bytes;
  std::vector<bool> flags;
  std::vector<std::int64_t> wholes;
  std::vector<double> reals;
  std::vector<std::string> texts;
  void serialize(Cdr& cdr) const {
    cdr << name << type << flag << whole << real << text << bytes << flags << wholes << reals << texts;
  }
  void deserialize(Cdr& cdr) {
    cdr >> name >> type >> flag >> whole >> real >> text >> bytes >> flags >> wholes >> reals >> texts;
  }
};
/// The two messages of SetParameters, with the header of rmw_cyclonedds_cpp.
struct SetRequest {
  static constexpr const char* name = "rcl_interfaces::srv::dds_::SetParameters_Request_";
  std::uint64_t client = 5;
  std::int64_t sequence = 0;
  std::vector<WireParameter> parameters;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, parameters);
  }
};
struct SetResponse {
  static constexpr const char* name = "rcl_interfaces::srv::dds_::SetParameters_Response_";
  std::uint64_t client = 0;
  std::int64_t sequence = 0;
  std::uint32_t count = 0;
  bool successful = false;
  std::string reason;
  template <class Archive>
  void fields(Archive& all) {
    all(client, sequence, count, successful, reason);
  }
};
struct WireEvent {
  static constexpr const char* name = "rcl_interfaces::msg::dds_::ParameterEvent_";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string node;
  std::vector<WireParameter> made, changed, gone;
  template <class Archive>
  void fields(Archive& all) {
    all(sec, nanosec, node, made, changed, gone);
  }
};
struct OneDiagnostic {
  static constexpr const char* name = "diagnostic_msgs::msg::dds_::DiagnosticArray_";
  fast::Header header;
  std::uint32_t count = 0;
  std::uint8_t level = 0;
  std::string subsystem, text, hardware;
  std::uint32_t values = 0;
  template <class Archive>
  void fields(Archive& all) {
    all(header.sec, header.nanosec, header.frame_id, count, level, subsystem, text, hardware, values);
  }
};

class OneGain final : public Ros2Host {
 public:
  [[nodiscard]] std::vector<Ros2Parameter> parameters() const override {
    const std::lock_guard lock(mutex_);
    return {{"robot.part.gain", Ros2Parameter::Kind::real, gain_, "", 0, 10}};
  }
  [[nodiscard]] std::optional<std::string> set(std::span<const Change> changes) override {
    const std::lock_guard lock(mutex_);
    if (changes[0].second == "11.5") return "11.5 is out of range";
    gain_ = changes[0].second;
    return std::nullopt;
  }
  [[nodiscard]] std::vector<Ros2Status> statuses() override {
    return {{"robot.part", Ros2Status::Level::warn, "2 new overruns", {}},
            {"cart.part", Ros2Status::Level::ok, "has no driver of ROS 2", {}}};
  }
  [[nodiscard]] std::string system() const override { return "depot"; }

 private:
  mutable std::mutex mutex_;
  std::string gain_ = "0.5";
};

TEST(NodesOfRos2, ThereIsNoneWithoutADriver) {
  OneGain host;
  std::string error = "something";
  EXPECT_EQ(make_nodes(host, error), nullptr);
  EXPECT_EQ(error, "");
}

TEST(NodesOfRos2, SetParametersTellOfThemAndPublishDiagnostics) {
  const auto effector =
      opened_effector(binding<Motion>("/cmd_vel", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega"));
  fast::Peer peer(test_domain());
  auto* const requests = peer.writer<SetRequest>("rq/robot/set_parametersRequest", true, "clientid=01.0f.9;");
  auto* const replies = peer.reader<SetResponse>("rr/robot/set_parametersReply", false, "clientid=01.0f.9;");
  auto* const events = peer.reader<WireEvent>("rt/parameter_events");
  auto* const diagnostics = peer.reader<OneDiagnostic>("rt/diagnostics");
  OneGain host;
  std::string error;
  auto nodes = make_nodes(host, error);
  ASSERT_NE(nodes, nullptr) << error;
  ASSERT_TRUE(eventually([&] {
    return fast::Peer::is_matched(*requests) && fast::Peer::is_matched(*replies) &&
           fast::Peer::is_matched(*events);
  }));
  SetRequest request;
  request.parameters.resize(1);
  request.parameters[0].name = "part.gain";
  std::optional<SetResponse> reply;
  const auto set = [&](double value) {
    request.parameters[0].real = value;
    return eventually([&] {  // a request is lost if the server has not found the client yet
      ++request.sequence;
      requests->write(&request);
      usleep(100'000);
      reply = fast::Peer::take<SetResponse>(*replies);
      return reply.has_value();
    });
  };
  ASSERT_TRUE(set(11.5));
  EXPECT_FALSE(reply->successful);
  EXPECT_EQ(reply->reason, "11.5 is out of range");
  EXPECT_EQ(host.parameters()[0].value, "0.5");
  ASSERT_TRUE(eventually([&] { return set(2.5) && reply->successful; }));
  EXPECT_EQ(reply->reason, "");
  EXPECT_EQ(host.parameters()[0].value, "2.5");
  std::optional<WireEvent> event;
  ASSERT_TRUE(eventually([&] {
    event = fast::Peer::take<WireEvent>(*events);
    return event && event->made.empty();
  }));
  EXPECT_EQ(event->node, "/robot");
  ASSERT_EQ(event->changed.size(), 1U);
  EXPECT_EQ(event->changed[0].name, "part.gain");
  EXPECT_EQ(event->changed[0].real, 2.5);
  std::optional<OneDiagnostic> shown;
  ASSERT_TRUE(
      eventually([&] { return (shown = fast::Peer::take<OneDiagnostic>(*diagnostics)).has_value(); }));
  EXPECT_EQ(shown->count, 1U);
  EXPECT_EQ(shown->level, 1);
  EXPECT_EQ(shown->subsystem, "robot: part");
  EXPECT_EQ(shown->text, "2 new overruns");
  EXPECT_EQ(shown->hardware, "depot");
  nodes.reset();
  effector->close();
}

TEST(NodesOfRos2, HaveTheNamesThatALaunchFileGives) {
  set_rules_of_process(Rules({{.of = Rule::Of::node, .to = "base"},
                              {.of = Rule::Of::name_space, .to = "/left"},
                              {.of = Rule::Of::any, .from = "/cmd_vel", .to = "cmd"},
                              {.of = Rule::Of::topic, .from = "/parameter_events", .to = "/events"}}));
  const auto effector =
      opened_effector(binding<Motion>("/cmd_vel", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega"));
  fast::Peer peer(test_domain());
  auto* const twists = peer.reader<fast::Twist>("rt/left/cmd");
  auto* const events = peer.reader<WireEvent>("rt/events");
  auto* const requests =
      peer.writer<SetRequest>("rq/left/base/set_parametersRequest", true, "clientid=01.0f.9;");
  OneGain host;
  std::string error;
  const auto nodes = make_nodes(host, error);
  set_rules_of_process({});
  ASSERT_NE(nodes, nullptr) << error;
  EXPECT_TRUE(eventually([&] { return fast::Peer::is_matched(*requests); }));
  EXPECT_TRUE(eventually([&] {
    return write(*effector, Motion{0.25, 0}) && fast::Peer::take<fast::Twist>(*twists).has_value();
  }));
  std::optional<WireEvent> event;
  double gain = 1.25;
  ASSERT_TRUE(eventually([&] {
    const Ros2Host::Change change{"robot.part.gain", std::to_string(gain += 0.25)};
    EXPECT_EQ(host.set({&change, 1}), std::nullopt);
    return (event = fast::Peer::take<WireEvent>(*events)).has_value();
  }));
  EXPECT_EQ(event->node, "/left/base");
}

}  // namespace
}  // namespace tessera::ros2
