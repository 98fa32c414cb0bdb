#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "../environment.hpp"
#include "oracle/nets/of_net.hpp"
#include "oracle/nets/reachability_graph.hpp"
#include "reduce/random_case.hpp"
#include "reduce/reduce.hpp"

namespace tessera::test {
namespace {

using oracle::Marking;
using oracle::ReachabilityGraph;
using reduce::Reduced;
using reduce::Rules;
using reduce::Statistics;

constexpr std::size_t most_markings = 400;

/// The long form of the test: TESSERA_RANDOM_NETS=20000.
std::uint64_t cases() { return from_environment("TESSERA_RANDOM_NETS", share_of(1000)); }

struct Rule {
  const char* name;
  bool Rules::*on;
  std::size_t Statistics::*count;
};
const std::vector<Rule> rules{
    {"dead_transitions", &Rules::dead_transitions, &Statistics::dead_transitions},
    {"parallel_transitions", &Rules::parallel_transitions, &Statistics::parallel_transitions},
    {"identity_transitions", &Rules::identity_transitions, &Statistics::identity_transitions},
    {"sink_places", &Rules::sink_places, &Statistics::sink_places},
    {"constant_places", &Rules::constant_places, &Statistics::constant_places},
    {"implicit_places", &Rules::implicit_places, &Statistics::implicit_places},
    {"start", &Rules::start, &Statistics::start},
    {"post_agglomeration", &Rules::post_agglomeration, &Statistics::post_agglomeration},
    {"pre_agglomeration", &Rules::pre_agglomeration, &Statistics::pre_agglomeration},
};

Rules only(const Rule& rule) {
  Rules on;
  for (const Rule& other : rules) on.*other.on = false;
  on.*rule.on = true;
  return on;
}

bool is_dead(const net::Net& net, const Marking& marking) {
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    if (oracle::fired(net, {index}, marking)) return false;
  return true;
}

std::optional<ReachabilityGraph::State> deadlock(const ReachabilityGraph& graph) {
  for (ReachabilityGraph::State state = 0; state < graph.size(); ++state)
    if (graph.dead(state)) return state;
  return std::nullopt;
}

/// From every marking, does some continuation fire one of the transitions of the net?
bool can_always_fire(const ReachabilityGraph& graph, const net::Net& net,
                     const std::vector<net::TransitionId>& any_of) {
  ReachabilityGraph::Transitions set(net.transitions().size());
  for (const net::TransitionId transition : any_of) set[transition.value] = 1;
  return oracle::every(graph.can_reach(graph.where_enabled(set)));
}

/// The combinations of tokens that the places reach.
std::set<Marking> reached(const ReachabilityGraph& graph, const std::vector<net::PlaceId>& places) {
  std::set<Marking> all;
  for (ReachabilityGraph::State state = 0; state < graph.size(); ++state) {
    Marking seen;
    for (const net::PlaceId place : places) seen.push_back(graph.marking(state)[place.value]);
    all.insert(seen);
  }
  return all;
}

std::vector<net::TransitionId> run_to(const ReachabilityGraph& graph, ReachabilityGraph::State state) {
  std::vector<net::TransitionId> run;
  for (const std::uint32_t transition : graph.run_to(state)) run.push_back({transition});
  return run;
}

class Comparison {
 public:
  Comparison(const RandomCase& given, const ReachabilityGraph& before, const Rules& on)
      : net_(given.net), what_(given.what), before_(before), reduced_(reduce::reduce(given.net, what_, on)) {}

  const Statistics& all() {
    // The reduced net may have unbounded places only if the original one has.
    const auto after = ReachabilityGraph::of(oracle::petri_net(reduced_.net), most_markings);
    EXPECT_TRUE(after);
    if (!after) return reduced_.statistics;
    EXPECT_EQ(deadlock(before_).has_value(), deadlock(*after).has_value());
    for (std::size_t set = 0; set < what_.sets.size(); ++set)
      EXPECT_EQ(can_always_fire(before_, net_, what_.sets[set]),
                can_always_fire(*after, reduced_.net, reduced_.sets[set]))
          << "set " << set;
    observed(*after);
    bounds(*after);
    traces(*after);
    return reduced_.statistics;
  }

 private:
  void observed(const ReachabilityGraph& after) const {
    std::vector<net::PlaceId> places;
    for (const net::PlaceId place : what_.observed) {
      ASSERT_TRUE(reduced_.find(place));
      places.push_back(*reduced_.find(place));
    }
    EXPECT_EQ(reached(before_, what_.observed), reached(after, places));
  }

  void bounds(const ReachabilityGraph& after) const {
    const auto most = [](const ReachabilityGraph& all, net::PlaceId place) {
      return reached(all, {place}).rbegin()->front();
    };
    for (std::uint32_t place = 0; place < net_.places().size(); ++place)
      if (const auto kept = reduced_.find({place})) {
        EXPECT_EQ(most(before_, {place}), most(after, *kept)) << net_.places()[place].name;
      }
  }

  void traces(const ReachabilityGraph& after) const {
    for (ReachabilityGraph::State state = 0; state < std::min<std::size_t>(after.size(), 20); ++state) {
      const auto end = oracle::replayed(net_, reduced_.lift(run_to(after, state)));
      ASSERT_TRUE(end);
      for (const net::PlaceId place : what_.observed)
        EXPECT_EQ((*end)[place.value], after.marking(state)[reduced_.find(place)->value]);
    }
    if (const auto dead = deadlock(after)) {
      const auto end = oracle::replayed(net_, reduced_.lift(run_to(after, *dead)));
      ASSERT_TRUE(end);
      EXPECT_TRUE(is_dead(net_, *end));
    }
  }

  const net::Net& net_;
  const reduce::Preserve& what_;
  const ReachabilityGraph& before_;
  Reduced reduced_;
};

/// Compares with the rules on; returns how often the counted one was applied.
std::size_t compare_random_nets(const Rules& on, std::size_t Statistics::*count) {
  std::size_t applied = 0;
  std::uint64_t compared = 0;
  for (std::uint32_t seed = 0; compared < cases(); ++seed) {
    RandomCase given = random_case(seed);
    const auto before = ReachabilityGraph::of(oracle::petri_net(given.net), most_markings);
    if (!before) continue;
    ++compared;
    // A true property may be reported or not.
    given.what.safe = before->safe() && seed % 3 != 0;
    const Statistics statistics = Comparison(given, *before, on).all();
    applied += statistics.*count;
    EXPECT_LE(statistics.places_after, statistics.places_before);
    if (::testing::Test::HasFailure()) {
      ADD_FAILURE() << "seed " << seed;
      break;
    }
  }
  return applied;
}

TEST(Reduce, EachRuleAloneKeepsTheAnswersOnRandomNets) {
  for (const Rule& rule : rules) {
    SCOPED_TRACE(rule.name);
    EXPECT_GT(compare_random_nets(only(rule), rule.count), share_of(50)) << "the rule was hardly tried";
    if (HasFailure()) break;
  }
}

TEST(Reduce, AllRulesTogetherKeepTheAnswersOnRandomNets) {
  EXPECT_GT(compare_random_nets({}, &Statistics::post_agglomeration), share_of(100));
}

TEST(Reduce, RulesThatAreOffAreNotApplied) {
  for (const Rule& rule : rules) {
    Rules on;
    on.*rule.on = false;
    std::size_t applied = 0;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
      const RandomCase given = random_case(seed);
      applied += reduce::reduce(given.net, given.what, on).statistics.*rule.count;
    }
    EXPECT_EQ(applied, 0U) << rule.name;
  }
}

}  // namespace
}  // namespace tessera::test
