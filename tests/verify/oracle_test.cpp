// The portfolio against exhaustive search, on small random systems.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "layers/exploration.hpp"
#include "layers/layers.hpp"
#include "layers/models.hpp"
#include "verify/abstraction.hpp"
#include "verify/verify.hpp"
#include "verify_circuits/naive_answers.hpp"
#include "verify_circuits/random_system.hpp"

namespace tessera::verify {
namespace {

/// The long form of the test: TESSERA_RANDOM_SYSTEMS=20000.
std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

bool any(const std::vector<bool>& flags) {
  return std::ranges::any_of(flags, [](bool flag) { return flag; });
}

/// The marking a run leads to; fails the test if it is none.
std::vector<std::uint32_t> replayed(const net::Net& net, const std::vector<net::TransitionId>& run) {
  std::vector<std::uint32_t> tokens;
  for (const net::Place& place : net.places()) tokens.push_back(place.tokens);
  for (const net::TransitionId id : run) {
    EXPECT_NE(net[id].condition.truth, net::Condition::Truth::never) << net[id].name;
    for (const net::Arc& arc : net.preset(id)) {
      EXPECT_GE(tokens[arc.place.value], arc.weight) << net[id].name << " is not enabled";
      tokens[arc.place.value] -= arc.weight;
    }
    for (const net::Arc& arc : net.postset(id)) tokens[arc.place.value] += arc.weight;
  }
  return tokens;
}

net::Net starting_in(const net::Net& net, const std::vector<std::uint32_t>& tokens) {
  net::Net other;
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    net::Place place = net.places()[index];
    place.tokens = tokens[index];
    other.add(std::move(place));
  }
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    other.add(net.transitions()[index], net.preset({index}), net.postset({index}));
  return other;
}

bool every_behaviour_runs(const net::Net& net) {
  const test::Exploration all = test::explore(net, 100000);
  std::vector<bool> marked(net.places().size(), false);
  for (const test::Marking& marking : all.markings)
    for (std::size_t place = 0; place < marking.size(); ++place)
      if (marking[place] > 0) marked[place] = true;
  for (std::size_t place = 0; place < marked.size(); ++place)
    if (net.places()[place].operation.kind == net::Operation::Kind::transition_function && !marked[place])
      return false;
  return true;
}

struct Tally {
  std::map<std::string, std::array<int, 3>> verdicts;
};

class Comparison {
 public:
  Comparison(const test::Built& built, const std::vector<net::Invariant>& invariants, Tally& tally)
      : built_(built), invariants_(invariants), tally_(tally) {}

  void with(const std::string& method, const net::Net& abstract, const test::NaiveAnswers& naive, bool live) {
    ProveOptions options;
    options.method = method;
    const Report report = prove({built_.net, &built_.pages, invariants_}, options);
    std::map<std::string, bool> truth{
        {"safe", true},
        {"exclusive_channels", true},
        {"sound_pages", true},
        {"deadlock_free", !naive.deadlock},
        {"goes_on", !any(naive.stuck)},
        {"live_behaviours", live},
    };
    if (const std::optional<bool> flow = channels_flow(naive)) truth["channels_flow"] = *flow;
    for (const PropertyResult& property : report.properties) {
      ++tally_.verdicts[property.name][static_cast<std::size_t>(property.verdict)];
      if (!truth.contains(property.name) || property.verdict == Verdict::unknown) continue;
      EXPECT_EQ(property.verdict == Verdict::holds, truth.at(property.name))
          << property.name << " by " << property.method << ": " << property.why;
      if (property.has_trace) shows(property, abstract);
    }
  }

 private:
  /// The search calls a channel dry as soon as its reader is about to end; the property does not, so where
  /// that is the only difference nothing is compared.
  static std::optional<bool> channels_flow(const test::NaiveAnswers& naive) {
    bool unclear = false;
    for (std::size_t channel = 0; channel < naive.dry.size(); ++channel) {
      if (naive.dry[channel] && !naive.reader_can_end[channel]) return false;
      unclear = unclear || naive.dry[channel];
    }
    return unclear ? std::nullopt : std::optional(true);
  }

  static void shows(const PropertyResult& property, const net::Net& abstract) {
    const net::Net after = starting_in(abstract, replayed(abstract, property.trace));
    const auto naive = test::explore_naively(after, 5000);
    if (!naive) return;
    if (property.name == "deadlock_free") {
      EXPECT_TRUE(naive->deadlock && naive->markings == 1) << "the run ends in no dead marking";
    }
    if (property.name == "goes_on") {
      EXPECT_TRUE(any(naive->stuck));
    }
    if (property.name == "channels_flow") {
      EXPECT_TRUE(any(naive->dry));
    }
  }

  const test::Built& built_;
  const std::vector<net::Invariant>& invariants_;
  Tally& tally_;
};

/// Every method by itself and all together, on as many systems as are small enough for the search.
Tally compared(spec::Model (*system)(std::uint64_t seed), std::uint64_t systems) {
  std::uint64_t seed = from_environment("TESSERA_RANDOM_SEED", 0);
  Tally tally, of_methods;
  for (std::uint64_t compared = 0; compared < systems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const spec::Model model = system(seed);
    const test::Built built = test::build(model);
    const net::Net abstract = abstract_net(built.net);
    const auto naive = test::explore_naively(abstract, 1500);
    if (!naive) continue;
    ++compared;
    const std::vector<net::Invariant> invariants = layers::invariants(model, built.pages, built.net);
    const bool live = every_behaviour_runs(possible_part(abstract));
    Comparison(built, invariants, tally).with("", abstract, *naive, live);
    for (const std::string& method : method_names())
      Comparison(built, invariants, of_methods).with(method, abstract, *naive, live);
    if (testing::Test::HasFailure()) break;
  }
  return tally;
}

void expect_both_verdicts(Tally tally) {
  for (const char* name : {"deadlock_free", "goes_on", "channels_flow"}) {
    const auto& [holds, violated, unknown] = tally.verdicts[name];
    EXPECT_GT(holds, 0) << name;
    EXPECT_GT(violated, 0) << name;
    EXPECT_EQ(unknown, 0) << name;
  }
}

TEST(Prove, AgreesWithExhaustiveSearchOnRandomSystems) {
  expect_both_verdicts(compared(test::random_system, from_environment("TESSERA_RANDOM_SYSTEMS", 150)));
}

TEST(Prove, AgreesWithExhaustiveSearchOnRandomSystemsOfOwnModels) {
  expect_both_verdicts(
      compared(test::random_system_of_own_models, from_environment("TESSERA_RANDOM_SYSTEMS", 100)));
}

}  // namespace
}  // namespace tessera::verify
