// Properties of an author on random systems: every method against exhaustive search of the abstract net.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "../environment.hpp"
#include "explore/budget.hpp"
#include "explore/formula_oracle.hpp"
#include "layers/layers.hpp"
#include "layers/models.hpp"
#include "oracle/nets/of_net.hpp"
#include "verify/communication/abstraction.hpp"
#include "verify/search/claims.hpp"
#include "verify/search/partial_nets.hpp"
#include "verify/verify.hpp"
#include "verify_circuits/random_system.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using explore::ReachabilityGraph;
using net::Statement;
using Claimed = net::Property::Kind;

/// The long form of the test: TESSERA_RANDOM_SYSTEMS=20000.
/// Statements as the layers make them of paths: pages, places, states of channels.
class Statements {
 public:
  Statements(const test::Built& built, oracle::Random& random) : built_(built), random_(random) {
    for (std::uint32_t page = 0; page < built.pages.pages.size(); ++page)
      if (built.pages.pages[page].layer == net::Layer::behaviour) behaviours_.push_back({page});
  }

  Statement statement(int depth) {
    const std::uint32_t kind = depth == 0 ? 0 : oracle::below(random_, 6);
    if (kind < 3) return oracle::below(random_, 3) > 0 ? running() : token();
    Statement made;
    made.kind =
        kind == 3 ? Statement::Kind::negation : (kind == 4 ? Statement::Kind::all : Statement::Kind::any);
    const std::uint32_t parts = kind == 3 ? 1 : 1 + oracle::below(random_, 2);
    for (std::uint32_t part = 0; part < parts; ++part) made.parts.push_back(statement(depth - 1));
    return made;
  }

 private:
  Statement running() {
    Statement made;
    made.page = behaviours_[oracle::below(random_, static_cast<std::uint32_t>(behaviours_.size()))];
    for (std::uint32_t place = 0; place < built_.net.places().size(); ++place)
      for (net::PageId at = built_.net.places()[place].page; at.valid();
           at = built_.pages.pages[at.value].parent)
        if (at == made.page) made.places.push_back({place});
    return made;
  }

  Statement token() {
    Statement made;
    made.places = {{oracle::below(random_, static_cast<std::uint32_t>(built_.net.places().size()))}};
    return made;
  }

  const test::Built& built_;
  oracle::Random& random_;
  std::vector<net::PageId> behaviours_;
};

bool claim_holds(const ReachabilityGraph& graph, Claimed kind, const net::Claim& claim) {
  const Formula what = formula_of(claim.what);
  switch (kind) {
    case Claimed::never:
      return !nearest(graph, what);
    case Claimed::always:
      return !nearest(graph, Formula::negation(what));
    case Claimed::reachable:
      return nearest(graph, what).has_value();
    case Claimed::always_reachable:
      return always_reachable(graph, what);
    case Claimed::leads_to:
      return leads_to(graph, what, formula_of(claim.then));
  }
  return false;
}

/// Does the marking at the end of a run break the claim?
bool broken_at(const ReachabilityGraph& graph, std::size_t end, Claimed kind, const net::Claim& claim) {
  const Formula what = formula_of(claim.what);
  switch (kind) {
    case Claimed::never:
      return explore::holds(graph, what, end);
    case Claimed::always:
      return !explore::holds(graph, what, end);
    case Claimed::reachable:
      return false;
    case Claimed::always_reachable:
      return !can_reach(graph, end, what);
    case Claimed::leads_to:
      return !can_reach(graph, end, formula_of(claim.then));
  }
  return false;
}

class PropertyComparison {
 public:
  PropertyComparison(const test::Built& built, const std::vector<net::Invariant>& invariants,
                     const ReachabilityGraph& graph)
      : built_(built), invariants_(invariants), abstract_(abstract_net(built.net)), graph_(graph) {}

  void with(const std::string& method, const std::vector<net::Property>& properties,
            std::map<std::string, std::array<int, 3>>& tally) {
    ProveOptions options;
    options.method = method;
    for (const net::Property& property : properties) options.only.push_back(property.name);
    const Report report = prove({built_.net, &built_.pages, invariants_, properties}, options);
    ASSERT_EQ(report.properties.size(), properties.size());
    for (std::size_t index = 0; index < properties.size(); ++index) {
      const PropertyResult& result = report.properties[index];
      ++tally[method][static_cast<std::size_t>(result.verdict)];
      compare(properties[index], result, method.empty() || method == "explicit");
    }
  }

 private:
  void compare(const net::Property& property, const PropertyResult& result, bool always_decides) {
    EXPECT_EQ(result.name, property.name);
    const bool expected = std::ranges::all_of(
        property.claims, [&](const net::Claim& claim) { return claim_holds(graph_, property.kind, claim); });
    if (result.verdict == Verdict::unknown) {
      EXPECT_FALSE(always_decides) << result.why;
      return;
    }
    EXPECT_EQ(result.verdict, expected ? Verdict::holds : Verdict::violated)
        << property.text << " by " << result.method << ": " << result.why;
    if (always_decides && !expected) {
      EXPECT_EQ(result.has_trace, property.kind != Claimed::reachable) << property.text;
    }
    if (result.has_trace) shows(property, result);
  }

  void shows(const net::Property& property, const PropertyResult& result) {
    std::size_t at = 0;
    for (const net::TransitionId id : result.trace) {
      const auto next = oracle::fired(abstract_, id, graph_.marking(at));
      ASSERT_TRUE(next) << abstract_[id].name << " is not enabled";
      at = graph_.find(*next).value();
    }
    EXPECT_TRUE(std::ranges::any_of(
        property.claims,
        [&](const net::Claim& claim) { return broken_at(graph_, at, property.kind, claim); }))
        << property.text << ": the run does not show it";
  }

  const test::Built& built_;
  const std::vector<net::Invariant>& invariants_;
  net::Net abstract_;
  const ReachabilityGraph& graph_;
};

std::vector<net::Property> random_properties(const test::Built& built, oracle::Random& random) {
  constexpr std::array kinds{Claimed::never, Claimed::always, Claimed::reachable, Claimed::always_reachable,
                             Claimed::leads_to};
  Statements statements(built, random);
  std::vector<net::Property> properties;
  for (const Claimed kind : kinds)
    for (int depth = 0; depth < 3; ++depth) {
      net::Property property;
      property.kind = kind;
      property.name = std::to_string(static_cast<int>(kind)) + " at depth " + std::to_string(depth);
      property.text = property.name;
      for (std::uint32_t claim = 1 + oracle::below(random, 2); claim > 0; --claim)
        property.claims.push_back({"", statements.statement(depth), statements.statement(depth)});
      properties.push_back(std::move(property));
    }
  return properties;
}

/// Compares what parts say in which as many places as possible count as one.
void expect_no_more(const test::Built& built, const std::vector<net::Invariant>& invariants,
                    const ReachabilityGraph& graph, const std::vector<net::Property>& properties,
                    int& holding) {
  const net::Net abstract = abstract_net(built.net);
  const PartialNets parts(abstract, invariants, 0);
  const explore::Budget budget({.time = std::chrono::minutes(1)});
  for (const net::Property& property : properties)
    for (const net::Claim& claim : property.claims) {
      const Formula what = what_of(property.kind, claim);
      PartialNets::Answer answer;
      if (property.kind == Claimed::never || property.kind == Claimed::always)
        answer = parts.never(what, budget);
      else if (property.kind == Claimed::always_reachable)
        answer = parts.reaches(Formula::always(), {what, {}}, budget);
      else if (property.kind == Claimed::leads_to)
        answer = parts.reaches(what, {formula_of(claim.then), {}}, budget);
      if (!answer.holds) continue;
      ++holding;
      EXPECT_TRUE(claim_holds(graph, property.kind, claim)) << property.text;
    }
  for (std::uint32_t subsystem = 0; subsystem < abstract.parts().subsystems.size(); ++subsystem) {
    std::set<net::TransitionId> all;
    std::vector<Formula> enabled;
    for (std::uint32_t index = 0; index < abstract.transitions().size(); ++index) {
      const net::TransitionId id{index};
      if (abstract[id].subsystem != net::SubsystemId{subsystem} || !possible(abstract, id)) continue;
      all.insert(id);
      enabled.push_back(Formula::enabled(id));
    }
    if (!parts.goes_on({subsystem}, {Formula::never(), all}, budget).holds) continue;
    ++holding;
    EXPECT_TRUE(always_reachable(graph, Formula::any(std::move(enabled)))) << subsystem;
  }
}

TEST(PropertiesOfTheAuthor, AgreeWithExhaustiveSearchOnRandomSystems) {
  const std::uint64_t systems = from_environment("TESSERA_RANDOM_SYSTEMS", share_of(60));
  std::uint64_t seed = from_environment("TESSERA_RANDOM_SEED", 0);
  std::map<std::string, std::array<int, 3>> tally;
  int holding = 0;
  for (std::uint64_t compared = 0; compared < systems; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const spec::Model model = test::random_system(seed);
    const test::Built built = test::build(model);
    const auto graph = explore::naive_graph(abstract_net(built.net), 400);
    if (!graph) continue;
    ++compared;
    const std::vector<net::Invariant> invariants = layers::invariants(model, built.pages, built.net);
    oracle::Random random(static_cast<std::uint32_t>(seed));
    const std::vector<net::Property> properties = random_properties(built, random);
    PropertyComparison comparison(built, invariants, *graph);
    for (const char* method : {"", "invariants", "circuits", "parts", "explicit"})
      comparison.with(method, properties, tally);
    expect_no_more(built, invariants, *graph, properties, holding);
    if (HasFailure()) return;
  }
  EXPECT_GT(holding, 0);
  if (sanitized) return;  // the few systems there need not have both verdicts
  for (const auto& [method, verdicts] : tally) {
    EXPECT_GT(verdicts[static_cast<std::size_t>(Verdict::holds)], 0) << method;
    if (method == "parts") continue;  // it only proves
    EXPECT_GT(verdicts[static_cast<std::size_t>(Verdict::violated)], 0) << method;
  }
}

}  // namespace
}  // namespace tessera::verify
