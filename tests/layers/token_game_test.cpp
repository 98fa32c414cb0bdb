#include <gtest/gtest.h>

#include "layers/exploration.hpp"
#include "layers/layers.hpp"
#include "layers/models.hpp"

namespace tessera::test {
namespace {

constexpr std::size_t limit = 20000;  // of the small models, which are explored as a whole
constexpr std::size_t sample = 3000;  // of markings checked one by one

template <class SomeNet>
std::set<std::set<std::string>> named(const SomeNet& net, const Exploration& found) {
  std::set<std::set<std::string>> all;
  for (const Marking& marking : found.markings) all.insert(marked(net, marking));
  return all;
}

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
    const Exploration flat = explore(built.net, limit), drawn = explore(built.pages, limit);
    ASSERT_TRUE(flat.complete);
    ASSERT_TRUE(drawn.complete);
    EXPECT_GT(flat.markings.size(), 20U);
    EXPECT_EQ(flat.markings.size(), drawn.markings.size());
    EXPECT_EQ(named(built.net, flat), named(built.pages, drawn));
  }
}

/// Every reachable marking (or as many as the limit allows) is safe and keeps every invariant.
void expect_kept(const spec::Model& model) {
  const Built built = build(model);
  const std::vector<net::Invariant> invariants = layers::invariants(model, built.pages, built.net);
  for (const Marking& marking : explore(built.net, sample).markings) {
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
