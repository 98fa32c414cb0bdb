#include <gmock/gmock.h>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;

class Convoy : public testing::Test {
 protected:
  Convoy() : reading_(golden("valid/convoy.yaml")) {}
  void SetUp() override { ASSERT_TRUE(reading_.model) << reading_.report(); }
  [[nodiscard]] const Model& model() const { return *reading_.model; }
  [[nodiscard]] std::vector<std::string> channel_names() const {
    std::vector<std::string> names;
    for (const Channel& channel : model().channels) names.push_back(model().channel_name(channel));
    return names;
  }
  [[nodiscard]] const Subsystem& follower() const { return model().definitions[0].subsystems[0]; }

  Reading reading_;
};

TEST_F(Convoy, AgentsOfATemplateShareItsDefinition) {
  std::vector<std::string> paths;
  for (const Agent& agent : model().agents) paths.push_back(agent.path);
  EXPECT_THAT(paths, ElementsAre("base", "robot[0]", "robot[1]", "robot[2]", "ring[0]", "ring[1]", "lone"));
  EXPECT_EQ(model().definitions.size(), 2U);
  EXPECT_TRUE(model().definition_of(model().agents[1]).is_template);
  EXPECT_EQ(model().agents[1].definition, model().agents[6].definition);
  EXPECT_EQ(model().agents[3].number, 2U);
  EXPECT_EQ(model().agents[1].fleet, model().agents[3].fleet);
  EXPECT_NE(model().agents[1].fleet, model().agents[4].fleet);
  EXPECT_FALSE(model().agents[6].fleet.valid());
}

TEST_F(Convoy, AnIndexedChannelStopsAtTheEndOfTheFleet) {
  EXPECT_THAT(channel_names(), Contains("robot[0].control.behind->robot[1].control.ahead"));
  EXPECT_THAT(channel_names(), Contains("robot[1].control.behind->robot[2].control.ahead"));
  EXPECT_THAT(channel_names(), Not(Contains("robot[2].control.behind->robot[0].control.ahead")));
}

TEST_F(Convoy, AnIndexedChannelGoesRoundARing) {
  EXPECT_THAT(channel_names(), Contains("ring[0].control.behind->ring[1].control.ahead"));
  EXPECT_THAT(channel_names(), Contains("ring[1].control.behind->ring[0].control.ahead"));
}

TEST_F(Convoy, AStarFeedsEveryAgentInOrder) {
  const auto names = channel_names();
  EXPECT_THAT(
      std::vector(names.begin(), names.begin() + 3),
      ElementsAre("base.control.order->robot[0].control.order", "base.control.order->robot[1].control.order",
                  "base.control.order->robot[2].control.order"));
}

TEST_F(Convoy, TimeoutOfOneSideBeatsTheCommonOne) {
  const Channel& channel = model().channels[5];
  EXPECT_EQ(model().channel_name(channel), "base.control.order->lone.control.order");
  EXPECT_EQ(channel.send_timeout, std::chrono::seconds(2));
  EXPECT_EQ(channel.receive_timeout, std::chrono::seconds(1));
}

TEST_F(Convoy, DriversOfAFleetCountItsAgents) {
  ASSERT_TRUE(model().simulation);
  ASSERT_EQ(model().simulation->drivers.size(), 4U);
  EXPECT_EQ(model().simulation->drivers[2].target(), "eye_2");
  EXPECT_EQ(model().simulation->drivers[2].options.at("noise"), (DriverOption{0.01, ""}));
  EXPECT_EQ(model().instance_path(model().simulation->drivers[2].instance), "robot[2].eye");
  EXPECT_EQ(model().drivers.size(), 3U);
  EXPECT_EQ(model().drivers[0].kind, "cpp");
}

TEST_F(Convoy, NextKnowsWhichConditionItAsksFor) {
  const Behaviour& follow = follower().behaviours[0];
  ASSERT_EQ(follow.next.size(), 5U);
  EXPECT_EQ(follow.next[0].when.kind, When::Kind::named_error);
  EXPECT_EQ(follow.next[0].when.expression.value, 0U);
  EXPECT_EQ(follow.next[1].when.kind, When::Kind::terminal);
  EXPECT_EQ(follow.next[1].when.expression.value, 0U);
  EXPECT_EQ(follow.next[2].when.kind, When::Kind::error);
  EXPECT_FALSE(follow.next[2].behaviour.valid());
  EXPECT_EQ(follow.next[3].when.kind, When::Kind::expression);
  EXPECT_EQ(follow.next[3].when.text.text, "parameters.slack > 0.1");
  EXPECT_EQ(follow.next[4].when.kind, When::Kind::always);
  EXPECT_EQ(follow.transfer, Transfer::parallel);
  EXPECT_EQ(follow.takes, (Takes{std::chrono::milliseconds(1), std::chrono::milliseconds(3)}));
  EXPECT_EQ(follow.receive, (std::vector<BufferId>{{0}, {1}}));
  EXPECT_EQ(follower().start.value, 1U);
}

TEST_F(Convoy, AnExpressionOfSeveralLinesBeginsAtItsFirst) {
  const Expression& go = follower().behaviours[1].terminal.expressions.at(0);
  EXPECT_EQ(go.text, "in.order.go &&\n  in.ahead.fresh");
  EXPECT_EQ(reading_.diagnostics.line(go.span.line), "            in.order.go &&");
  EXPECT_EQ(go.span.column, 13U);
}

TEST_F(Convoy, AQuotedExpressionHasTheSpanOfItsText) {
  const Expression& stopped = follower().behaviours[0].terminal.expressions.at(1);
  const auto line = reading_.diagnostics.line(stopped.span.line);
  EXPECT_EQ(line.substr(stopped.span.column - 1, stopped.span.length), "!in.order.go");
}

TEST_F(Convoy, PropertiesWithoutNamesAreNamedByTheirText) {
  EXPECT_EQ(model().properties[0].name, "never robot[0].control.follow");
  EXPECT_EQ(model().properties[1].text, "base.control.command => lone.control.follow");
}

TEST(Aliases, StandForTheirAnchor) {
  const Reading reading(golden("valid/aliases.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_EQ(reading.model->subsystem({1}).period, std::chrono::milliseconds(50));
  EXPECT_EQ(reading.model->subsystem({2}).period, std::chrono::milliseconds(50));
}

}  // namespace
}  // namespace tessera::spec
