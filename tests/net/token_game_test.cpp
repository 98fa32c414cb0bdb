#include "net/token_game.hpp"

#include <gtest/gtest.h>

namespace tessera::net {
namespace {

constexpr TransitionId join{0}, back{1};

/// `join` takes two tokens of place 0 and one of place 1 and gives one to place 2; `back` undoes it by half.
Net small_net() {
  Net net;
  for (const std::uint32_t tokens : {3U, 1U, 0U}) net.add(Place{.tokens = tokens});
  net.add(Transition{}, std::vector<Arc>{{{0}, 2}, {{1}}}, std::vector<Arc>{{{2}}});
  net.add(Transition{}, std::vector<Arc>{{{2}}}, std::vector<Arc>{{{0}}, {{1}}});
  return net;
}

TEST(TokenGame, ATransitionNeedsTheWeightOfEveryInput) {
  const Net net = small_net();
  EXPECT_TRUE(enabled(net, join, {2, 1, 0}));
  EXPECT_FALSE(enabled(net, join, {1, 1, 0}));
  EXPECT_FALSE(enabled(net, join, {2, 0, 0}));
  EXPECT_TRUE(suffices({2, 0, 0}, {{0}, 2}));
}

TEST(TokenGame, AFiringTakesAndGives) {
  const Net net = small_net();
  Marking marking = initial_marking(net);
  fire(net, join, marking);
  EXPECT_EQ(marking, (Marking{1, 0, 1}));
  EXPECT_EQ(marking_after(net, std::vector{join, back}), (Marking{2, 1, 0}));
}

TEST(TokenGame, ARunIsFiredAsAWholeOrNotAtAll) {
  const Net net = small_net();
  Marking marking = initial_marking(net);
  EXPECT_FALSE(fire_all(net, std::vector{join, back, join, join}, marking));
  EXPECT_EQ(marking, initial_marking(net));
  EXPECT_TRUE(fire_all(net, std::vector{join, back, join}, marking));
  EXPECT_EQ(marking, (Marking{0, 0, 1}));
}

}  // namespace
}  // namespace tessera::net
