#include "verify/counterexample/tidy_run.hpp"

#include <gtest/gtest.h>

#include <random>

#include "explore/explore.hpp"
#include "faults.hpp"
#include "proved.hpp"
#include "verify/communication/abstraction.hpp"

namespace tessera::verify {
namespace {

using Firings = std::vector<net::TransitionId>;

/// A run of so many firings at the most, each drawn from what may fire.
Firings walk(const net::Net& net, std::uint32_t seed, std::size_t firings) {
  const explore::PtNet compiled(net);
  explore::Marking marking = compiled.initial();
  std::mt19937 random(seed);
  Firings run;
  while (run.size() < firings) {
    std::vector<std::uint32_t> enabled;
    for (std::uint32_t index = 0; index < compiled.transitions(); ++index)
      if (compiled.enabled(index, marking)) enabled.push_back(index);
    if (enabled.empty()) break;
    const std::uint32_t chosen = enabled[random() % enabled.size()];
    compiled.fire(chosen, marking);
    run.push_back({chosen});
  }
  return run;
}

std::size_t changes_of_subsystem(const net::Net& net, const Firings& run) {
  std::size_t changes = 0;
  for (std::size_t at = 1; at < run.size(); ++at)
    changes += net[run[at]].subsystem != net[run[at - 1]].subsystem ? 1 : 0;
  return changes;
}

net::Net net_of(const char* name) { return abstract_net(flattened(fault(name).faulty)); }

TEST(TidyRun, EndsWhereTheRunEndsAndIsNeitherLongerNorMoreScattered) {
  for (const char* name : {"crossed blocking receives", "a ring that waits on itself", "a relay that ends",
                           "no initial condition may hold", "a request that is taken back"}) {
    const net::Net net = net_of(name);
    const explore::PtNet compiled(net);
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      const Firings run = walk(net, seed, 40);
      const Firings tidied = tidy(net, run);
      EXPECT_EQ(explore::replay(compiled, tidied), explore::replay(compiled, run));
      EXPECT_LE(tidied.size(), run.size());
      EXPECT_LE(changes_of_subsystem(net, tidied), changes_of_subsystem(net, run));
      EXPECT_EQ(tidy(net, tidied).size(), tidied.size());
    }
  }
}

TEST(TidyRun, LeavesOutRoundsThatChangeNothing) {
  const net::Net net = net_of("one of two consumers ends");
  const Firings run = walk(net, 3, 300);
  EXPECT_LT(tidy(net, run).size(), 60U) << "of " << run.size();
}

TEST(TidyRun, LeavesARunAloneThatIsNone) {
  const net::Net net = net_of("a relay that ends");
  const auto last = static_cast<std::uint32_t>(net.transitions().size() - 1);
  const Firings no_run{{last}, {last}};
  EXPECT_EQ(tidy(net, no_run), no_run);
}

}  // namespace
}  // namespace tessera::verify
