#include <gtest/gtest.h>

#include "../environment.hpp"
#include "formula_oracle.hpp"
#include "siphons/exclusion.hpp"

namespace tessera::siphons {
namespace {

using explore::Formula;
using explore::ReachabilityGraph;
using oracle::Random;

/// The long form of the test: TESSERA_RANDOM_NETS=20000.
std::uint64_t cases() { return from_environment("TESSERA_RANDOM_NETS", share_of(1000)); }

struct Tally {
  std::uint32_t questions = 0, impossible = 0, excluded = 0;
};

void compare(const net::Net& net, const ReachabilityGraph& naive, const Formula& goal, Tally& tally) {
  const Exclusion found = exclude(explore::PtNet(net), goal, {});
  ASSERT_NE(found.kind, Exclusion::Kind::gave_up) << found.why;
  const bool possible = nearest(naive, goal).has_value();
  ++tally.questions;
  tally.impossible += possible ? 0 : 1;
  if (found.kind != Exclusion::Kind::excluded) return;
  ++tally.excluded;
  EXPECT_FALSE(possible);
}

TEST(Exclusion, AgreesWithTheOracleOnRandomNets) {
  Tally tally;
  for (std::uint32_t seed = 0; seed < cases(); ++seed) {
    Random random(seed);
    const net::Net net = seed % 3 == 0   ? explore::random_weighted(random)
                         : seed % 3 == 1 ? explore::random_machines(random)
                                         : explore::random_wild(random);
    const auto naive = explore::naive_graph(net, 300);
    if (!naive) continue;
    compare(net, *naive, Formula::dead(), tally);
    for (int formula = 0; formula < 4; ++formula)
      compare(net, *naive, explore::random_formula(random, net, 2), tally);
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
  }
  std::printf("%u questions, of something impossible %u, excluded %u\n", tally.questions, tally.impossible,
              tally.excluded);
  EXPECT_GT(tally.excluded, tally.impossible / 3);
  EXPECT_GT(tally.excluded, cases() / 10);
}

}  // namespace
}  // namespace tessera::siphons
