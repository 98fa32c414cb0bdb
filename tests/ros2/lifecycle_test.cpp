// The states of a managed node, and the bytes of lifecycle_msgs.
#include "ros2/lifecycle/lifecycle.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "ros2/codec/cdr.hpp"
#include "ros2/definitions/resolver.hpp"
#include "ros2/lifecycle/messages.hpp"

namespace tessera::ros2 {
namespace {

using NodeLife = LifecycleState;
using NodeOrder = LifecycleOrder;
using NodeOutcome = LifecycleOutcome;

std::vector<NodeLife> goal_states(Lifecycle& life) {
  std::vector<NodeLife> all;
  for (const LifecycleTransition& step : life.take_steps()) all.push_back(step.to);
  return all;
}

TEST(Lifecycle, GoesTheWayOfAManagedNode) {
  Lifecycle life;
  EXPECT_EQ(life.state(), NodeLife::unconfigured);
  EXPECT_EQ(life.request(1, ""), NodeOrder::configure);
  EXPECT_EQ(life.state(), NodeLife::configuring);
  life.finish(NodeOutcome::success);
  EXPECT_EQ(life.request(0, "activate"), NodeOrder::activate);
  life.finish(NodeOutcome::success);
  EXPECT_EQ(life.state(), NodeLife::active);
  EXPECT_EQ(life.request(4, ""), NodeOrder::deactivate);
  life.finish(NodeOutcome::success);
  EXPECT_EQ(life.request(1, "cleanup"), NodeOrder::cleanup) << "the label counts";
  life.finish(NodeOutcome::success);
  EXPECT_EQ(life.request(5, ""), NodeOrder::shutdown);
  life.finish(NodeOutcome::success);
  EXPECT_EQ(goal_states(life),
            (std::vector{NodeLife::configuring, NodeLife::inactive, NodeLife::activating, NodeLife::active,
                         NodeLife::deactivating, NodeLife::inactive, NodeLife::cleaning_up,
                         NodeLife::unconfigured, NodeLife::shutting_down, NodeLife::finalized}));
}

TEST(Lifecycle, RefusesAllThatDoesNotFit) {
  Lifecycle life;
  for (const int id : {0, 2, 3, 4, 6, 7, 8, 10, 11, 50, 60, 97, 255})
    EXPECT_FALSE(life.request(static_cast<std::uint8_t>(id), "")) << id;
  for (const char* label : {"activate", "transition_success", "Configure", "create"})
    EXPECT_FALSE(life.request(1, label)) << label;
  ASSERT_TRUE(life.begin(NodeOrder::configure));
  for (int id = 0; id < 256; ++id) EXPECT_FALSE(life.request(static_cast<std::uint8_t>(id), "")) << id;
  EXPECT_FALSE(life.begin(NodeOrder::shutdown));
  life.finish(NodeOutcome::success);
  EXPECT_EQ(life.state(), NodeLife::inactive);
  life.finish(NodeOutcome::success);
  EXPECT_EQ(life.state(), NodeLife::inactive) << "no order was under way";
}

TEST(Lifecycle, AFailureGoesBackAndAnErrorLeavesTheNodeUnconfigured) {
  Lifecycle life;
  ASSERT_TRUE(life.begin(NodeOrder::configure));
  life.finish(NodeOutcome::failure);
  EXPECT_EQ(goal_states(life), (std::vector{NodeLife::configuring, NodeLife::unconfigured}));
  ASSERT_TRUE(life.begin(NodeOrder::configure));
  life.finish(NodeOutcome::success);
  ASSERT_TRUE(life.begin(NodeOrder::activate));
  life.finish(NodeOutcome::error);
  EXPECT_EQ(goal_states(life), (std::vector{NodeLife::configuring, NodeLife::inactive, NodeLife::activating,
                                            NodeLife::error_processing, NodeLife::unconfigured}));
  ASSERT_TRUE(life.begin(NodeOrder::configure));
  life.finish(NodeOutcome::success);
  ASSERT_TRUE(life.begin(NodeOrder::activate));
  life.finish(NodeOutcome::success);
  static_cast<void>(life.take_steps());
  life.fail();
  const std::vector<LifecycleTransition> steps = life.take_steps();
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].from, NodeLife::active);
  EXPECT_EQ(steps[0].to, NodeLife::error_processing);
  EXPECT_EQ(life.state(), NodeLife::unconfigured);
}

TEST(Lifecycle, OffersTheTransitionsOfTheState) {
  std::map<NodeLife, std::set<int>> ids;
  for (const LifecycleTransition& one : lifecycle_transitions()) ids[one.from].insert(one.id);
  EXPECT_EQ(ids[NodeLife::unconfigured], (std::set{1, 5}));
  EXPECT_EQ(ids[NodeLife::inactive], (std::set{2, 3, 6}));
  EXPECT_EQ(ids[NodeLife::active], (std::set{4, 7}));
  EXPECT_EQ(ids[NodeLife::error_processing], (std::set{60, 61, 62}));
  EXPECT_TRUE(ids[NodeLife::finalized].empty());
  EXPECT_EQ(lifecycle_states().size(), 11U);
  Lifecycle life;
  EXPECT_EQ(life.available().size(), 2U);
}

TEST(LifecycleMessages, AreTheBytesOfTheirDefinitions) {
  const auto bytes = [](const std::vector<std::byte>& message) {
    std::string text;
    for (const std::byte one : message) text += std::to_string(std::to_integer<int>(one)) + " ";
    return text;
  };
  EXPECT_EQ(bytes(state_answer(NodeLife::active)), "0 1 0 1 3 0 0 0 7 0 0 0 97 99 116 105 118 101 0 0 ");
  EXPECT_EQ(bytes(change_answer(true)), "0 1 0 3 1 0 0 0 ");
  const DefinitionFolders folders({std::string(TESSERA_SOURCE_DIR) + "/share/tessera/ros2"});
  for (const char* type :
       {"lifecycle_msgs/msg/TransitionEvent", "lifecycle_msgs/msg/TransitionDescription"}) {
    std::vector<Mistake> mistakes;
    EXPECT_NE(resolve(type, folders, mistakes), nullptr) << type;
    EXPECT_TRUE(mistakes.empty()) << type;
  }
}

TEST(LifecycleMessages, ARequestOfAnyBytesIsReadOrRefused) {
  std::vector<std::byte> message;
  CdrWriter writer(message);
  const std::uint8_t id = 3;
  writer.number(&id, sizeof id);
  writer.text("activate");
  writer.finish();
  const auto read = read_change_request(message);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->id, 3);
  EXPECT_EQ(read->label, "activate");
  for (std::size_t size = 0; size + 4 < message.size(); ++size)
    EXPECT_FALSE(read_change_request(std::span(message).first(size))) << size;
  std::mt19937 random(1);
  for (int round = 0; round < 20'000; ++round) {
    std::vector<std::byte> other = message;
    other.resize(random() % 40);
    for (std::size_t flips = random() % 4; flips > 0 && !other.empty(); --flips)
      other[random() % other.size()] = static_cast<std::byte>(random());
    const auto any = read_change_request(other);
    EXPECT_TRUE(!any || any->label.size() <= other.size());
  }
}

}  // namespace
}  // namespace tessera::ros2
