// ROS 2 sees our nodes, and users are told of endpoints that do not fit.
#include "ros2/dds/graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "eventually.hpp"
#include "fast_peer.hpp"
#include "ros2/dds/endpoint.hpp"
#include "stderr_text.hpp"
#include "tessera/bounded_string.hpp"

namespace tessera::ros2 {
namespace {

class GraphWithFastDds : public testing::Test {
 protected:
  fast::Peer peer{test_domain()};
};

/// A node that reads an announcement of ours sees this.
template <class Form>
void expect_one_writer(const Form& node) {
  EXPECT_EQ(node.nodes, 1U);
  EXPECT_EQ(node.node_namespace, "/");
  EXPECT_EQ(node.node_name, "robot");
  EXPECT_EQ(node.readers, 0U);
  EXPECT_EQ(node.writers, 1U);
  // Endpoints begin like their participant and end in what they are.
  EXPECT_TRUE(std::equal(node.participant.begin(), node.participant.begin() + 12, node.writer.begin()));
  EXPECT_NE(node.participant, node.writer);
  EXPECT_EQ(node.participant[15], 0xc1);
}

/// Humble's nodes throw when they read the later form, so it is written only where nobody writes Humble's.
TEST_F(GraphWithFastDds, IsANodeForToolsOfRos2InTheFormThatTheyWrite) {
  const char* const topic = "ros_discovery_info";
  using Humble = fast::OneWriter<24>;
  using Later = fast::OneWriter<16>;
  auto* const nodes = peer.reader<Humble>(topic, /*transient_local=*/true);
  auto effector =
      opened_effector(binding<Motion>("/cmd_vel", "geometry_msgs/msg/Twist", "linear.x=v, angular.z=omega"));
  std::optional<Humble> first;
  ASSERT_TRUE(eventually([&] { return (first = fast::Peer::take<Humble>(*nodes)).has_value(); }));
  expect_one_writer(*first);
  {
    fast::Peer later(test_domain());
    auto* const its_nodes = later.reader<Later>(topic, /*transient_local=*/true);
    Later announced{.node_name = "later"};
    auto* const writer = later.writer<Later>(topic, true, "", /*transient_local=*/true);
    std::optional<Later> node;
    ASSERT_TRUE(eventually([&] {
      writer->write(&announced);
      while (const auto one = fast::Peer::take<Later>(*its_nodes))
        if (one->node_name == "robot") node = one;
      return node.has_value();
    }));
    expect_one_writer(*node);
    // A node of Humble joins, so both forms were heard.
    while (fast::Peer::take<Humble>(*nodes)) continue;
    fast::Peer humble(test_domain());
    auto* const old_writer = humble.writer<Humble>(topic, true, "", /*transient_local=*/true);
    Humble old{.node_name = "old"};
    ASSERT_TRUE(eventually([&] {
      old_writer->write(&old);
      while (const auto one = fast::Peer::take<Humble>(*nodes))
        if (one->node_name == "robot") return true;
      return false;
    }));
  }
}

TEST(Graph, TellsTheFormsOfAnnouncementsApart) {
  const auto form = [](std::size_t identifier, std::initializer_list<int> rest) {
    std::vector<std::byte> message(4, std::byte{0});
    message.insert(message.end(), 16, std::byte{7});
    message.insert(message.end(), identifier - 16, std::byte{0});
    for (const int byte : rest) message.push_back(static_cast<std::byte>(byte));
    return identifier_size_in(message);
  };
  EXPECT_EQ(form(24, {0, 0, 0, 0}), 24U) << "no nodes";
  EXPECT_EQ(form(16, {0, 0, 0, 0}), 16U) << "no nodes";
  EXPECT_EQ(form(24, {1, 0, 0, 0, 2, 0, 0, 0, '/', 0}), 24U);
  EXPECT_EQ(form(16, {1, 0, 0, 0, 2, 0, 0, 0, '/', 0, 0, 0}), 16U);
  EXPECT_EQ(form(16, {0, 1, 0, 0, 2, 0, 0, 0, '/', 0, 0, 0}), 16U) << "256 nodes";
  EXPECT_EQ(form(16, {}), std::nullopt);
}

TEST_F(GraphWithFastDds, TellsBothSidesOfAMisfitOnceAndGivesNoAdviceAboutTheNetwork) {
  const StderrText told;
  auto* const writer = peer.writer<fast::Text>("rt/words", /*reliable=*/false);
  auto* const ear_of_peer = peer.reader<fast::Text>("rt/said", /*transient_local=*/true);
  ASSERT_TRUE(writer != nullptr && ear_of_peer != nullptr);
  auto ear = opened_receptor(binding<BoundedString<16>>("/words", "std_msgs/msg/String"));
  auto mouth = opened_effector(binding<BoundedString<16>>("/said", "std_msgs/msg/String"));
  BoundedString<16> heard;
  const std::string of_reliability =
      "a publisher of /words offers reliability best_effort, and ours requests reliable (`qos: { "
      "reliability: "
      "best_effort }` in the driver would fit), so that nothing passes";
  const std::string of_durability =
      "a subscriber of /said requests durability transient_local, and ours offers volatile (`qos: { "
      "durability: "
      "transient_local }` in the driver would fit), so that nothing passes";
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(read(*ear, heard));
    EXPECT_TRUE(write(*mouth, heard));
    return told.has(of_reliability) && told.has(of_durability);
  })) << told.now();
  EXPECT_FALSE(told.has("nobody")) << told.now();
  EXPECT_EQ(told.now().find(of_reliability), told.now().rfind(of_reliability)) << told.now();
}

TEST_F(GraphWithFastDds, TellsOfAPublisherWithAnotherType) {
  const StderrText told;
  ASSERT_NE(peer.writer<fast::Twist>("rt/words"), nullptr);
  EndpointSetup setup;
  setup.path = "robot.ear.heard";
  setup.topic = "/words";
  setup.dds_topic = "rt/words";
  setup.dds_type = "std_msgs::msg::dds_::String_";
  setup.node = "/robot";
  setup.network.domain = test_domain();
  const Endpoint ear(setup, /*writes=*/false);
  EXPECT_TRUE(eventually([&] { return ear.tell_of_misfits(); }));
  EXPECT_TRUE(
      told.has("robot.ear.heard: a publisher of /words has the type geometry_msgs::msg::dds_::Twist_, and "
               "ours is std_msgs::msg::dds_::String_, so that nothing passes between them"))
      << told.now();
}

}  // namespace
}  // namespace tessera::ros2
