// Chains of the section `timing`, as the model has them.
#include <gtest/gtest.h>

#include <string>

#include "spec_reading.hpp"

namespace tessera::spec {
namespace {

std::string leads(const Model& model, const TimedChain& chain) {
  std::string text;
  for (std::size_t at = 0; at < chain.path.size(); ++at) {
    text += model.instance_path(chain.path[at]);
    if (at == chain.hops.size()) break;
    for (const ChannelId id : chain.hops[at])
      text += " " +
              model.subsystem(model.channels[id].from.instance).outputs[model.channels[id].from.buffer].name;
    text += " ";
  }
  return text;
}

TEST(Timing, ChainsOfAFleetAreOneForEachMember) {
  const Reading reading(golden("valid/timing.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  const Model& model = *reading.model;
  EXPECT_EQ(model.timing.latency.count(), 0);
  ASSERT_TRUE(model.timing.chains);
  const std::vector<TimedChain>& chains = *model.timing.chains;
  ASSERT_EQ(chains.size(), 6U);  // the fleet is no ring, so two lead to a next member
  EXPECT_EQ(chains[1].name, "line to wheels[1]");
  EXPECT_EQ(leads(model, chains[1]), "robot[1].sensor line copy robot[1].control motion robot[1].motor");
  EXPECT_EQ(chains[1].age, std::chrono::milliseconds(100));
  EXPECT_EQ(chains[1].reaction, std::chrono::milliseconds(200));
  EXPECT_EQ(chains[3].name, "by the copy");
  EXPECT_EQ(leads(model, chains[3]), "robot[0].sensor copy robot[0].control motion robot[0].motor");
  EXPECT_FALSE(chains[3].asks());
  EXPECT_EQ(chains[4].name, "behind[0]");
  EXPECT_EQ(leads(model, chains[4]),
            "robot[0].sensor line robot[0].control tail robot[1].control motion robot[1].motor");
}

TEST(Timing, WithoutChainsNoneAreNamed) {
  const Reading reading(golden("valid/line_follower.yaml"));
  ASSERT_TRUE(reading.model) << reading.report();
  EXPECT_FALSE(reading.model->timing.chains);
  EXPECT_EQ(reading.model->timing.latency.count(), 0);
}

}  // namespace
}  // namespace tessera::spec
