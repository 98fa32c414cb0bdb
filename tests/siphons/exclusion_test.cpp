#include "siphons/exclusion.hpp"

#include <gtest/gtest.h>

#include "small_nets.hpp"

namespace tessera::siphons {
namespace {

using explore::Formula;
using explore::PtNet;
using Kind = Exclusion::Kind;

Exclusion dead(const net::Net& net, const explore::Limits& limits = {}) {
  return exclude(PtNet(net), Formula::dead(), limits);
}

TEST(Exclusion, WhatKeepsATokenNeverDies) {
  EXPECT_EQ(dead(explore::ring_of(5, 1)).kind, Kind::excluded);
  EXPECT_EQ(dead(explore::ring_of(5, 3)).kind, Kind::excluded);
  EXPECT_EQ(dead(explore::spring()).kind, Kind::excluded);
}

TEST(Exclusion, ADeadEndIsSuspectedWithItsMarking) {
  const Exclusion found = dead(explore::fork_in_the_road());
  EXPECT_EQ(found.kind, Kind::suspected);
  EXPECT_EQ(found.marked, std::vector<net::PlaceId>{net::PlaceId{2}});
  EXPECT_EQ(dead(explore::philosophers(5)).kind, Kind::suspected);
}

// All philosophers hold their left fork, or none does: the last one takes the right one first.
TEST(Exclusion, OnePhilosopherOfAnotherHandExcludesTheDeadlock) {
  net::Net net = explore::places_with({1, 0, 0, 1, 1, 0, 0, 1});
  explore::join(net, {{0, 1}, {3, 1}}, {{1, 1}});
  explore::join(net, {{1, 1}, {7, 1}}, {{2, 1}});
  explore::join(net, {{2, 1}}, {{0, 1}, {3, 1}, {7, 1}});
  explore::join(net, {{4, 1}, {3, 1}}, {{5, 1}});
  explore::join(net, {{5, 1}, {7, 1}}, {{6, 1}});
  explore::join(net, {{6, 1}}, {{4, 1}, {3, 1}, {7, 1}});
  EXPECT_EQ(dead(net).kind, Kind::excluded);
}

TEST(Exclusion, TwoPlacesOfOneUnitAreNotMarkedTogether) {
  const auto flat = explore::ring_of(3, 1);
  const PtNet net(flat);
  const Formula both = Formula::all({Formula::marked({0}), Formula::marked({2})});
  EXPECT_EQ(exclude(net, both, {}).kind, Kind::excluded);
  EXPECT_EQ(exclude(net, Formula::at_least({1}, 2), {}).kind, Kind::excluded);
  EXPECT_EQ(exclude(net, Formula::marked({2}), {}).kind, Kind::suspected);
  EXPECT_EQ(exclude(net, Formula::enabled({1}), {}).kind, Kind::suspected);
}

TEST(Exclusion, ALimitIsKept) {
  explore::Limits limits;
  limits.time = std::chrono::duration<double>(0);
  const Exclusion found = dead(explore::philosophers(5), limits);
  EXPECT_EQ(found.kind, Kind::gave_up);
  EXPECT_NE(found.why.find("time limit"), std::string::npos) << found.why;
}

}  // namespace
}  // namespace tessera::siphons
