#include <gtest/gtest.h>

#include <algorithm>

#include "layers/layers.hpp"
#include "layers/models.hpp"
#include "verify/verify.hpp"

namespace tessera::test {
namespace {

std::string why(const spec::Model& model) {
  const Built built = build(model);
  const verify::Report report = verify::check(built.net, layers::invariants(model, built.pages, built.net));
  return report.all_hold() ? "holds" : report.properties.at(0).why;
}

TEST(LayerInvariants, ProveTheLineFollowerSafe) { EXPECT_EQ(why(line_follower()), "holds"); }

TEST(LayerInvariants, ProveEveryPairOfModesSafe) {
  for (const auto send : {N, B})
    for (const auto receive : {N, B})
      for (const bool timeouts : {false, true})
        for (const auto transfer : {spec::Transfer::sequential, spec::Transfer::parallel})
          for (std::size_t channels = 0; channels <= 3; ++channels) {
            const Modes modes{send, receive, timeouts && send == B, timeouts && receive == B};
            EXPECT_EQ(why(pair(std::vector<Modes>(channels, modes), transfer)), "holds");
          }
}

TEST(LayerInvariants, ProveRandomModelsSafe) {
  for (std::uint32_t seed = 1; seed <= 300; ++seed)
    EXPECT_EQ(why(random_model(seed)), "holds") << "seed " << seed;
}

// Waits of one channel in branches of different behaviours: each is bounded only through its first branch.
TEST(LayerInvariants, BoundAnAcknowledgementWaitedForInSeveralBranches) {
  spec::Model model = pair({{B, B}, {B, B}, {B, N}}, spec::Transfer::parallel);
  auto& behaviours = model.definitions[0].subsystems[0].behaviours;
  spec::Behaviour back = behaviours[0];
  back.name = "back";
  back.send = std::vector<spec::BufferId>{{2}, {1}, {0}};
  spec::Behaviour single = behaviours[0];
  single.name = "single";
  single.send = std::vector<spec::BufferId>{{1}};
  behaviours.push_back(back);
  behaviours.push_back(single);
  EXPECT_EQ(why(model), "holds");
}

TEST(LayerInvariants, AreOnePerSubsystemBranchChannelAndAcknowledgement) {
  const spec::Model model = pair({{B, B}, {B, N}, {N, N}}, spec::Transfer::parallel);
  const Built built = build(model);
  // 2 subsystems; 2 further branches each of give.snd and take.rcv; 3 channels; 2 acknowledgements.
  EXPECT_EQ(layers::invariants(model, built.pages, built.net).size(), 2U + 4 + 3 + 2);
}

TEST(LayerInvariants, GrowLinearlyWithTheFleet) {
  const auto terms = [](std::uint32_t agents) {
    const spec::Model model = fleet(agents);
    const Built built = build(model);
    std::size_t sum = 0;
    for (const net::Invariant& invariant : layers::invariants(model, built.pages, built.net))
      sum += invariant.terms.size();
    return sum;
  };
  EXPECT_EQ(terms(20), 20 * terms(1));
}

}  // namespace
}  // namespace tessera::test
