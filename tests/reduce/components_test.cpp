#include "reduce/components.hpp"

#include <gtest/gtest.h>

#include "reduce/fleet_nets.hpp"
#include "reduce/reduce.hpp"

namespace tessera::test {
namespace {

TEST(Components, EqualAgentsAreOfOneKind) {
  for (const auto& [mix, kinds, per_agent] :
       {std::tuple(Mix::async, 3U, 3U), std::tuple(Mix::both_block, 1U, 1U)}) {
    const net::Net net = fleet_net({12, mix, mix, Topology::alone, Form::one_template});
    const auto reduced = reduce::reduce(net, {.sets = per_subsystem(net), .safe = true});
    const reduce::Components found = reduce::components(reduced.net, reduced.sets);
    EXPECT_EQ(found.all.size(), 12 * per_agent);
    EXPECT_EQ(found.kinds, kinds);
  }
}

TEST(Components, ARingIsOne) {
  const net::Net net = fleet_net(*fleet_named("nbring", 5));
  const auto reduced = reduce::reduce(net, {.sets = per_subsystem(net), .safe = true});
  EXPECT_EQ(reduce::components(reduced.net, reduced.sets).all.size(), 1U);
}

/// `tokens` in the first of two places that a transition joins, once per element.
net::Net pairs(const std::vector<std::uint32_t>& tokens) {
  net::Net net;
  for (std::size_t number = 0; number < tokens.size(); ++number) {
    const std::string path = "r[" + std::to_string(number) + "].";
    net::Place place;
    place.name = path + "a";
    place.tokens = tokens[number];
    const net::PlaceId from = net.add(place);
    place.name = path + "b";
    place.tokens = 0;
    const net::PlaceId to = net.add(place);
    net::Transition transition;
    transition.name = path + "t";
    net.add(transition, std::vector<net::Arc>{{from}}, std::vector<net::Arc>{{to}});
  }
  return net;
}

TEST(Components, DifferentMarkingsAndSetsAreOfDifferentKinds) {
  EXPECT_EQ(reduce::components(pairs({1, 1, 1})).kinds, 1U);
  EXPECT_EQ(reduce::components(pairs({1, 0, 1})).kinds, 2U);
  EXPECT_EQ(reduce::components(pairs({1, 1, 1}), {{{0}}, {{1}}, {{2}}}).kinds, 1U);
  EXPECT_EQ(reduce::components(pairs({1, 1, 1}), {{{0}}, {{1}}}).kinds, 2U);
}

TEST(Components, CorrespondingElementsComeInTheSameOrder) {
  const net::Net net = pairs({1, 1});
  const reduce::Components found = reduce::components(net);
  ASSERT_EQ(found.all.size(), 2U);
  for (std::size_t index = 0; index < 2; ++index)
    EXPECT_EQ(reduce::template_name(net[found.all[0].places[index]].name),
              reduce::template_name(net[found.all[1].places[index]].name));
}

TEST(Components, NumbersOfAgentsAreLeftOutOfNames) {
  EXPECT_EQ(reduce::template_name("r[3].control.y->r[4].control.x.full"),
            "r[].control.y->r[].control.x.full");
}

}  // namespace
}  // namespace tessera::test
