#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "reduce/naive_explorer.hpp"
#include "reduce/random_net.hpp"
#include "reduce/reduce.hpp"

namespace tessera::test {
namespace {

using reduce::Reduced;
using reduce::Rules;
using reduce::Statistics;

constexpr std::size_t most_markings = 400;

/// The long form of the test: TESSERA_RANDOM_NETS=20000.
std::uint64_t cases() {
  const char* text = std::getenv("TESSERA_RANDOM_NETS");
  return text == nullptr ? 1000 : std::strtoull(text, nullptr, 10);
}

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

/// Where a lifted trace leads, or nullopt if it does not replay.
std::optional<Tokens> replay(const net::Net& net, const std::vector<net::TransitionId>& trace) {
  Tokens marking = initial(net);
  for (const net::TransitionId transition : trace) {
    if (net[transition].condition.truth == net::Condition::Truth::never) return std::nullopt;
    const auto next = fire(net, marking, transition);
    if (!next) return std::nullopt;
    marking = *next;
  }
  return marking;
}

bool is_dead(const net::Net& net, const Tokens& marking) {
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    if (net.transitions()[index].condition.truth != net::Condition::Truth::never &&
        fire(net, marking, {index}))
      return false;
  return true;
}

std::set<net::TransitionId> as_set(const std::vector<net::TransitionId>& transitions) {
  return {transitions.begin(), transitions.end()};
}

class Comparison {
 public:
  Comparison(const RandomCase& given, const NaiveExplorer& before, const Rules& on)
      : net_(given.net), what_(given.what), before_(before), reduced_(reduce::reduce(given.net, what_, on)) {}

  const Statistics& all() {
    // The reduced net may have unbounded places only if the original one has.
    const auto after = NaiveExplorer::explore(reduced_.net, most_markings);
    EXPECT_TRUE(after);
    if (!after) return reduced_.statistics;
    EXPECT_EQ(before_.deadlock().has_value(), after->deadlock().has_value());
    for (std::size_t set = 0; set < what_.sets.size(); ++set)
      EXPECT_EQ(before_.can_always_fire(as_set(what_.sets[set])),
                after->can_always_fire(as_set(reduced_.sets[set])))
          << "set " << set;
    observed(*after);
    bounds(*after);
    traces(*after);
    return reduced_.statistics;
  }

 private:
  void observed(const NaiveExplorer& after) const {
    std::vector<net::PlaceId> places;
    for (const net::PlaceId place : what_.observed) {
      ASSERT_TRUE(reduced_.find(place));
      places.push_back(*reduced_.find(place));
    }
    EXPECT_EQ(before_.reached(what_.observed), after.reached(places));
  }

  void bounds(const NaiveExplorer& after) const {
    const auto most = [](const NaiveExplorer& all, net::PlaceId place) {
      std::uint32_t tokens = 0;
      for (const Tokens& marking : all.markings()) tokens = std::max(tokens, marking[place.value]);
      return tokens;
    };
    for (std::uint32_t place = 0; place < net_.places().size(); ++place)
      if (const auto kept = reduced_.find({place})) {
        EXPECT_EQ(most(before_, {place}), most(after, *kept)) << net_.places()[place].name;
      }
  }

  void traces(const NaiveExplorer& after) const {
    for (std::uint32_t marking = 0; marking < std::min<std::size_t>(after.markings().size(), 20); ++marking) {
      const auto end = replay(net_, reduced_.lift(after.trace_to(marking)));
      ASSERT_TRUE(end);
      for (const net::PlaceId place : what_.observed)
        EXPECT_EQ((*end)[place.value], after.markings()[marking][reduced_.find(place)->value]);
    }
    if (const auto deadlock = after.deadlock()) {
      const auto end = replay(net_, reduced_.lift(after.trace_to(*deadlock)));
      ASSERT_TRUE(end);
      EXPECT_TRUE(is_dead(net_, *end));
    }
  }

  const net::Net& net_;
  const reduce::Preserve& what_;
  const NaiveExplorer& before_;
  Reduced reduced_;
};

/// Compares with the rules on; returns how often the counted one was applied.
std::size_t compare_random_nets(const Rules& on, std::size_t Statistics::*count) {
  std::size_t applied = 0;
  std::uint64_t compared = 0;
  for (std::uint64_t seed = 0; compared < cases(); ++seed) {
    RandomCase given = random_case(seed);
    const auto before = NaiveExplorer::explore(given.net, most_markings);
    if (!before) continue;
    ++compared;
    // What is true may be said or not.
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
    EXPECT_GT(compare_random_nets(only(rule), rule.count), 50U) << "the rule was hardly tried";
    if (HasFailure()) break;
  }
}

TEST(Reduce, AllRulesTogetherKeepTheAnswersOnRandomNets) {
  EXPECT_GT(compare_random_nets({}, &Statistics::post_agglomeration), 100U);
}

TEST(Reduce, RulesThatAreOffAreNotApplied) {
  for (const Rule& rule : rules) {
    Rules on;
    on.*rule.on = false;
    std::size_t applied = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const RandomCase given = random_case(seed);
      applied += reduce::reduce(given.net, given.what, on).statistics.*rule.count;
    }
    EXPECT_EQ(applied, 0U) << rule.name;
  }
}

}  // namespace
}  // namespace tessera::test
