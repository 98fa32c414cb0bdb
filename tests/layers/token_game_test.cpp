#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "layers/drawn_net.hpp"
#include "layers/layers.hpp"
#include "layers/models.hpp"
#include "oracle/nets/of_net.hpp"
#include "oracle/nets/reachability_graph.hpp"

namespace tessera::test {
namespace {

using oracle::Marking;
using oracle::ReachabilityGraph;

constexpr std::size_t limit = 20000;  // of the small models, which are explored as a whole
constexpr std::size_t sample = 3000;  // of markings checked one by one

/// The marked places by name, "name" or "name*2".
std::set<std::string> marked(const std::vector<std::string>& names, const Marking& marking) {
  std::set<std::string> all;
  for (std::size_t place = 0; place < marking.size(); ++place)
    if (marking[place] > 0)
      all.insert(names[place] + (marking[place] == 1 ? "" : "*" + std::to_string(marking[place])));
  return all;
}

std::set<std::set<std::string>> named(const std::vector<std::string>& names, const ReachabilityGraph& graph) {
  std::set<std::set<std::string>> all;
  for (ReachabilityGraph::State state = 0; state < graph.size(); ++state)
    all.insert(marked(names, graph.marking(state)));
  return all;
}

std::vector<std::string> place_names(const net::Net& net) {
  std::vector<std::string> names;
  for (const net::Place& place : net.places()) names.push_back(place.name);
  return names;
}

oracle::PetriNet free_net(const net::Net& net) { return oracle::petri_net(net, oracle::Conditions::free); }

std::vector<spec::Model> small_models() {
  std::vector<spec::Model> models{pair({}), pair({{N, N}, {B, B}}),
                                  pair({{N, B, false, true}, {B, N, true, false}})};
  for (const auto transfer : {spec::Transfer::sequential, spec::Transfer::parallel})
    models.push_back(pair({{B, B, true, true}, {N, B}}, transfer));
  return models;
}

TEST(TokenGame, OnThePagesReachesTheMarkingsOfTheFlatNet) {
  for (const spec::Model& model : small_models()) {
    const Built built = build(model);
    const DrawnNet pages = drawn_net(built.pages);
    const auto flat = ReachabilityGraph::of(free_net(built.net), limit);
    const auto drawn = ReachabilityGraph::of(pages.game, limit);
    ASSERT_TRUE(flat);
    ASSERT_TRUE(drawn);
    EXPECT_GT(flat->size(), 20U);
    EXPECT_EQ(flat->size(), drawn->size());
    EXPECT_EQ(named(place_names(built.net), *flat), named(pages.names, *drawn));
  }
}

/// Every reachable marking (or as many as the limit allows) is safe and keeps every invariant.
void expect_kept(const spec::Model& model) {
  const Built built = build(model);
  const std::vector<net::Invariant> invariants = layers::invariants(model, built.pages, built.net);
  const ReachabilityGraph graph(free_net(built.net), sample);
  for (ReachabilityGraph::State state = 0; state < graph.size(); ++state) {
    const Marking& marking = graph.marking(state);
    for (std::uint32_t place = 0; place < marking.size(); ++place)
      ASSERT_LE(marking[place], 1U) << built.net.places()[place].name;
    for (const net::Invariant& invariant : invariants) {
      std::int64_t sum = 0;
      for (const auto& term : invariant.terms) sum += std::int64_t{term.weight} * marking[term.place.value];
      ASSERT_EQ(sum, invariant.total) << invariant.name;
    }
  }
}

TEST(TokenGame, KeepsTheInvariantsOfSmallModels) {
  for (const spec::Model& model : small_models()) expect_kept(model);
  expect_kept(line_follower());
}

TEST(TokenGame, KeepsTheInvariantsOfRandomModels) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    expect_kept(random_model(seed));
  }
}

}  // namespace
}  // namespace tessera::test
