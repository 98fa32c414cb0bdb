#include "siphons/traps.hpp"

#include <gtest/gtest.h>

#include "small_nets.hpp"

namespace tessera::siphons {
namespace {

using explore::PtNet;
using Places = std::vector<std::uint32_t>;

TEST(Traps, ARingIsOneAndNoPartOfItIs) {
  const auto flat = explore::ring_of(4, 1);
  const PtNet net(flat);
  PlaceSet all(4, 1);
  shrink_to_trap(net, all);
  EXPECT_EQ(all, PlaceSet({1, 1, 1, 1}));
  PlaceSet part{1, 1, 1, 0};
  shrink_to_trap(net, part);
  EXPECT_EQ(part, PlaceSet({0, 0, 0, 0}));
}

TEST(Traps, APlaceThatNothingLeavesIsOne) {
  const auto flat = explore::fork_in_the_road();
  PlaceSet set(3, 1);
  set[0] = 0;
  shrink_to_trap(PtNet(flat), set);
  EXPECT_EQ(set, PlaceSet({0, 1, 1}));
}

// A philosopher's own left fork is in its hand or on the table; a trap needs no more places than that.
TEST(Traps, ASmallMarkedOneLeavesOutWhatItDoesNotNeed) {
  const auto flat = explore::philosophers(3);
  const PtNet net(flat);
  const Places trap = small_marked_trap(net, PlaceSet(net.places(), 1));
  ASSERT_FALSE(trap.empty());
  EXPECT_LE(trap.size(), 4U);
  PlaceSet set(net.places(), 0);
  for (const std::uint32_t place : trap) set[place] = 1;
  PlaceSet same = set;
  shrink_to_trap(net, same);
  EXPECT_EQ(set, same);
  EXPECT_LT(marked_place(net, set), net.places());
}

TEST(Traps, AnUnmarkedOneIsNoUse) {
  EXPECT_TRUE(small_marked_trap(PtNet(explore::fork_in_the_road()), {0, 1, 1}).empty());
}

}  // namespace
}  // namespace tessera::siphons
