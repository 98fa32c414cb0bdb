#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <set>

#include "../environment.hpp"
#include "executor_oracle.hpp"
#include "oracle/nets/reachability_graph.hpp"

// TESSERA_RANDOM_NETS asks for more nets than an everyday run plays.

namespace tessera::testing {
namespace {

constexpr std::uint32_t most_tokens = 20;

[[nodiscard]] NetExecutor::Options by_lot(std::uint64_t seed) {
  return {.ties = NetExecutor::Ties::random, .seed = seed, .bound = most_tokens};
}

void give_priorities(ExecutableNet& net, Random& random, std::uint32_t different) {
  for (ExecutableNet::Transition& transition : net.transitions)
    transition.priority = static_cast<std::int32_t>(random() % different) - 1;
}

/// After every firing the executor and the oracle agree on marking and enabled transitions, and what fired
/// had the highest priority. Returns the firings.
std::uint64_t play_in_step(const ExecutableNet& net, NetExecutor::Options options, std::uint64_t most) {
  NaiveRun naive(net);
  std::uint32_t fired = 0;
  options.on_firing = [&](std::uint32_t transition) { fired = transition; };
  const auto executor = load(net, options);
  std::uint64_t firings = 0;
  for (; firings < most; ++firings) {
    const std::vector<std::uint32_t> enabled = naive.enabled();
    EXPECT_EQ(executor->enabled(), enabled);
    const NetExecutor::Outcome outcome = executor->run(1);
    if (outcome.end == NetExecutor::End::dead) {
      EXPECT_TRUE(enabled.empty());
    }
    if (outcome.end == NetExecutor::End::fault) {
      EXPECT_NE(outcome.fault.find("more than"), std::string::npos);
    }
    if (outcome.end != NetExecutor::End::limit) break;
    for (const std::uint32_t other : enabled)
      EXPECT_LE(net.transitions[other].priority, net.transitions[fired].priority);
    EXPECT_TRUE(naive.fire(fired));
    EXPECT_EQ(executor->marking(), naive.marking());
    if (::testing::Test::HasFailure()) break;
  }
  return firings;
}

TEST(RandomNets, EveryFiringIsLegalAndEnablingIsExact) {
  const std::uint64_t nets = from_environment("TESSERA_RANDOM_NETS", share_of(3000));
  std::uint64_t firings = 0;
  for (std::uint32_t seed = 0; seed < nets && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    ExecutableNet net = random_net(random);
    give_priorities(net, random, 1 + seed % 3);
    firings += play_in_step(net, {.bound = most_tokens}, 60);
    firings += play_in_step(net, by_lot(seed), 60);
  }
  EXPECT_GT(firings, 10 * nets);
}

/// All markings that can be reached, and those of them that are dead.
struct Outcomes {
  std::set<Marking> reachable, dead;
};
/// nullopt: more than `most` markings, or a place outgrows the bound of the executor.
[[nodiscard]] std::optional<Outcomes> outcomes(const ExecutableNet& net, std::size_t most) {
  const auto graph = oracle::ReachabilityGraph::of(petri_net(net), most);
  if (!graph || graph->most_tokens() > most_tokens) return std::nullopt;
  Outcomes result;
  for (std::size_t state = 0; state < graph->size(); ++state) {
    result.reachable.insert(graph->marking(state));
    if (graph->dead(state)) result.dead.insert(graph->marking(state));
  }
  return result;
}

[[nodiscard]] bool includes(const std::set<Marking>& all, const std::set<Marking>& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

/// The firings of a run by lot, from the start on, until nothing is enabled or `most` have been made.
struct LongRun {
  std::set<Marking> seen;
  bool legal = true;
  NetExecutor::End end{};
  Marking last;
};
[[nodiscard]] LongRun run_by_lot(const ExecutableNet& net, std::uint64_t seed, std::uint64_t most) {
  LongRun result;
  NaiveRun naive(net);
  NetExecutor::Options options = by_lot(seed);
  options.on_firing = [&](std::uint32_t transition) {
    result.legal = naive.fire(transition) && result.legal;
    result.seen.insert(naive.marking());
  };
  result.seen.insert(naive.marking());
  const auto executor = load(net, options);
  result.end = executor->run(most).end;
  result.last = executor->marking();
  result.legal = result.legal && result.last == naive.marking();
  return result;
}

TEST(RandomNets, RunsByLotStayWithinTheOutcomesOfTheOracle) {
  const std::uint64_t nets = from_environment("TESSERA_RANDOM_NETS", share_of(3000));
  std::uint32_t dead_ends = 0;
  for (std::uint32_t seed = 0; seed < nets && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const ExecutableNet net = random_net(random);
    const auto expected = outcomes(net, 200);
    if (!expected) continue;
    for (std::uint64_t run = 0; run < 5; ++run) {
      const LongRun result = run_by_lot(net, run, 200);
      EXPECT_TRUE(result.legal);
      EXPECT_TRUE(includes(expected->reachable, result.seen));
      EXPECT_EQ(result.end == NetExecutor::End::dead, expected->dead.contains(result.last));
      dead_ends += result.end == NetExecutor::End::dead ? 1 : 0;
    }
  }
  EXPECT_GT(dead_ends, nets / 2);
}

/// All markings that executors get to with one firing by lot from `marking`: as many lots as it takes for
/// each of the enabled transitions to have been drawn, or far too many.
[[nodiscard]] std::set<Marking> successors_by_lot(ExecutableNet net, const Marking& marking) {
  for (std::size_t place = 0; place < marking.size(); ++place) net.places[place].tokens = marking[place];
  std::set<Marking> result;
  std::set<std::uint32_t> drawn;
  std::size_t ways = 1;
  for (std::uint64_t seed = 0; drawn.size() < ways && seed < 100 * ways; ++seed) {
    NetExecutor::Options options = by_lot(seed);
    options.on_firing = [&](std::uint32_t transition) { drawn.insert(transition); };
    const auto executor = load(net, options);
    ways = executor->enabled().size();
    if (executor->run(1).firings == 1) result.insert(executor->marking());
  }
  return result;
}

TEST(RandomNets, LotsReachExactlyTheOutcomesOfTheOracle) {
  const std::uint64_t nets = from_environment("TESSERA_RANDOM_NETS", share_of(3000));
  std::uint32_t compared = 0, with_dead_ends = 0;
  for (std::uint32_t seed = 0; seed < nets && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const ExecutableNet net = random_net(random);
    const auto expected = outcomes(net, 40);
    if (!expected) continue;
    std::vector<Marking> open{NaiveRun(net).marking()};
    Outcomes found{{open.begin(), open.end()}, {}};
    while (!open.empty()) {
      const Marking marking = open.back();
      open.pop_back();
      const std::set<Marking> successors = successors_by_lot(net, marking);
      if (successors.empty()) found.dead.insert(marking);
      for (const Marking& next : successors)
        if (found.reachable.insert(next).second) open.push_back(next);
    }
    EXPECT_EQ(found.reachable, expected->reachable);
    EXPECT_EQ(found.dead, expected->dead);
    ++compared;
    with_dead_ends += found.dead.empty() ? 0 : 1;
  }
  EXPECT_GT(compared, nets / 4);
  EXPECT_GT(with_dead_ends, nets / 10);
}

/// A firing that is not observed takes a way of its own through the code.
TEST(RandomNets, ObservingChangesNothing) {
  const std::uint64_t nets = from_environment("TESSERA_RANDOM_NETS", share_of(3000));
  for (std::uint32_t seed = 0; seed < nets && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const ExecutableNet net = random_net(random);
    const auto observed = load(net, {.bound = most_tokens, .on_firing = [](std::uint32_t) {}});
    const auto unobserved = load(net, {.bound = most_tokens});
    for (const std::uint64_t most : {1U, 7U, 50U}) {
      const NetExecutor::Outcome a = observed->run(most), b = unobserved->run(most);
      EXPECT_EQ(a.end, b.end);
      EXPECT_EQ(a.firings, b.firings);
      EXPECT_EQ(observed->marking(), unobserved->marking());
    }
  }
}

}  // namespace
}  // namespace tessera::testing
