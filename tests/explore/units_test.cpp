#include "explore/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "formula_oracle.hpp"
#include "small_nets.hpp"

namespace tessera::explore {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<std::vector<std::uint32_t>> sorted_places(const std::vector<Unit>& units) {
  std::vector<std::vector<std::uint32_t>> result;
  for (const Unit& unit : units) {
    result.push_back(unit.places);
    std::ranges::sort(result.back());
  }
  return result;
}

TEST(Units, ARingWithOneTokenIsAUnitThatIsAlwaysMarked) {
  const std::vector<Unit> units = find_units(PtNet(ring_of(5, 1)));
  ASSERT_EQ(units.size(), 1U);
  EXPECT_TRUE(units[0].always_one);
  EXPECT_THAT(sorted_places(units), ElementsAre(ElementsAre(0, 1, 2, 3, 4)));
}

TEST(Units, ARingWithTwoTokensHasNone) { EXPECT_THAT(find_units(PtNet(ring_of(5, 2))), IsEmpty()); }

TEST(Units, PlacesThatGainTokensAreInNone) { EXPECT_THAT(find_units(PtNet(spring())), IsEmpty()); }

TEST(Units, ATokenMayBeLost) {
  net::Net net = places_with({1, 0});
  join(net, {{0, 1}}, {{1, 1}});
  join(net, {{1, 1}}, {});
  const std::vector<Unit> units = find_units(PtNet(net));
  for (const Unit& unit : units) EXPECT_FALSE(unit.always_one);
  EXPECT_THAT(sorted_places(units), UnorderedElementsAre(ElementsAre(0), ElementsAre(0 + 1)));
}

TEST(Units, CoverTheDiningPhilosophers) {
  std::size_t covered = 0;
  for (const Unit& unit : find_units(PtNet(philosophers(7)))) covered += unit.places.size();
  EXPECT_EQ(covered, 28U);
}

TEST(Units, HoldAtMostOneTokenInEveryMarkingOfRandomNets) {
  std::size_t units = 0;
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(seed);
    oracle::Random random(seed);
    const net::Net net = random_machines(random);
    const auto graph = naive_graph(net, 300);
    if (!graph) continue;
    std::vector<int> uses(net.places().size(), 0);
    for (const Unit& unit : find_units(PtNet(net))) {
      ++units;
      for (const std::uint32_t place : unit.places) EXPECT_EQ(uses[place]++, 0);
      for (std::size_t index = 0; index < graph->size(); ++index) {
        Tokens sum = 0;
        for (const std::uint32_t place : unit.places) sum += graph->marking(index)[place];
        EXPECT_LE(sum, 1U);
        if (unit.always_one) {
          EXPECT_EQ(sum, 1U);
        }
      }
    }
  }
  EXPECT_GT(units, 2000U);
}

}  // namespace
}  // namespace tessera::explore
