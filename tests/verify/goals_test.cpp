// Goals over places, with reductions, components and equal parts, against a graph that the textbook has.

#include "verify/search/goals.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "../environment.hpp"
#include "explore/formula_oracle.hpp"
#include "oracle/nets/of_net.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using explore::ReachabilityGraph;
using oracle::below;
using oracle::Random;
using Kind = Found::Kind;
constexpr std::size_t most_naive_markings = 300;

/// Adds a copy of a net as one agent of a fleet.
void add_copy(net::Net& to, const net::Net& net, std::uint32_t agent) {
  const auto first = static_cast<std::uint32_t>(to.places().size());
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    net::Place place = net.places()[index];
    place.name = "a[" + std::to_string(agent) + "].p" + std::to_string(index);
    to.add(std::move(place));
  }
  const auto moved = [&](std::span<const net::Arc> arcs) {
    std::vector<net::Arc> result;
    for (const net::Arc& arc : arcs) result.push_back({{arc.place.value + first}, arc.weight});
    return result;
  };
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    to.add(net.transitions()[index], moved(net.preset({index})), moved(net.postset({index})));
}

/// One small net, or a fleet of two of one kind.
net::Net random_fleet(Random& random) {
  const net::Net one =
      below(random, 2) == 0 ? explore::random_machines(random) : explore::random_weighted(random);
  net::Net fleet;
  const std::uint32_t agents = 1 + below(random, 2);
  for (std::uint32_t agent = 0; agent < agents; ++agent) add_copy(fleet, one, agent);
  return fleet;
}

/// A formula over places; those of the second agent are as likely as those of the first.
Formula random_goal(Random& random, const net::Net& net, int depth) {
  const std::uint32_t kind = depth == 0 ? 0 : below(random, 5);
  if (kind < 2)
    return Formula::at_least({below(random, static_cast<std::uint32_t>(net.places().size()))},
                             1 + (below(random, 6) == 0 ? 1 : 0));
  if (kind == 2) return Formula::negation(random_goal(random, net, depth - 1));
  std::vector<Formula> parts;
  for (std::uint32_t part = 1 + below(random, 3); part > 0; --part)
    parts.push_back(random_goal(random, net, depth - 1));
  return kind == 3 ? Formula::all(std::move(parts)) : Formula::any(std::move(parts));
}

class GoalComparison {
 public:
  GoalComparison(const net::Net& net, const ReachabilityGraph& naive) : net_(net), naive_(naive) {}

  void with(Ask question, const std::vector<Goal>& goals, bool safe) {
    const Kind nothing_stops = Kind::unknown;
    const std::vector<Found> found = ask(net_, question, goals, nothing_stops, {safe}, {});
    ASSERT_EQ(found.size(), goals.size());
    for (std::size_t goal = 0; goal < goals.size(); ++goal) compare(question, goals[goal], found[goal]);
  }

  std::array<std::array<int, 2>, 3> answers{};

 private:
  [[nodiscard]] bool truth(Ask question, const Goal& goal) const {
    switch (question) {
      case Ask::reachable:
        return nearest(naive_, goal.what).has_value();
      case Ask::always_reachable:
        return always_reachable(naive_, goal.what);
      case Ask::leads_to:
        return leads_to(naive_, goal.what, goal.then);
    }
    return false;
  }

  void compare(Ask question, const Goal& goal, const Found& found) {
    const bool expected = truth(question, goal);
    ++answers[static_cast<std::size_t>(question)][expected ? 1 : 0];
    ASSERT_EQ(found.kind, expected ? Kind::yes : Kind::no) << static_cast<int>(question) << found.why;
    if (expected == (question == Ask::reachable)) shows(question, goal, found);
  }

  void shows(Ask question, const Goal& goal, const Found& found) {
    std::size_t at = 0;
    bool between = explore::holds(naive_, goal.what, at) && !explore::holds(naive_, goal.then, at);
    for (const net::TransitionId id : found.trace) {
      const auto next = oracle::fired(net_, id, naive_.marking(at));
      ASSERT_TRUE(next) << "the trace does not replay";
      at = naive_.find(*next).value();
      between = (between || explore::holds(naive_, goal.what, at)) && !explore::holds(naive_, goal.then, at);
    }
    if (question == Ask::reachable) {
      EXPECT_TRUE(explore::holds(naive_, goal.what, at));
    }
    if (question == Ask::always_reachable) {
      EXPECT_FALSE(can_reach(naive_, at, goal.what));
    }
    if (question == Ask::leads_to) {
      EXPECT_TRUE(between) << "the run passes `then`, or does not come to `what`";
      EXPECT_FALSE(can_reach(naive_, at, goal.then));
    }
  }

  const net::Net& net_;
  const ReachabilityGraph& naive_;
};

TEST(Goals, AgreeWithTheOracleOnRandomNets) {
  const std::uint64_t nets = from_environment("TESSERA_RANDOM_NETS", share_of(2000));
  std::array<std::array<int, 2>, 3> answers{};
  std::uint32_t seed = 0;
  for (std::uint64_t compared = 0; compared < nets; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const net::Net net = random_fleet(random);
    const auto naive = explore::naive_graph(net, most_naive_markings);
    if (!naive) continue;
    ++compared;
    GoalComparison comparison(net, *naive);
    const bool safe = naive->most_tokens() <= 1 && below(random, 4) > 0;
    for (const Ask question : {Ask::reachable, Ask::always_reachable, Ask::leads_to}) {
      std::vector<Goal> goals;
      for (std::uint32_t goal = 1 + below(random, 3); goal > 0; --goal)
        goals.push_back({random_goal(random, net, 2),
                         question == Ask::leads_to ? random_goal(random, net, 2) : Formula::never()});
      comparison.with(question, goals, safe);
    }
    for (std::size_t question = 0; question < answers.size(); ++question)
      for (std::size_t answer = 0; answer < 2; ++answer)
        answers[question][answer] += comparison.answers[question][answer];
    if (testing::Test::HasFailure()) return;
  }
  for (const auto& [no, yes] : answers) {
    EXPECT_GT(no, 0);
    EXPECT_GT(yes, 0);
  }
}

/// `count` agents that each go from p0 to p1 and back, or for good.
net::Net walkers(std::uint32_t count, bool back) {
  net::Net one;
  one.add({.name = "p0", .tokens = 1});
  one.add({.name = "p1"});
  one.add(net::Transition{}, std::vector<net::Arc>{{{0}, 1}}, std::vector<net::Arc>{{{1}, 1}});
  if (back) one.add(net::Transition{}, std::vector<net::Arc>{{{1}, 1}}, std::vector<net::Arc>{{{0}, 1}});
  net::Net fleet;
  for (std::uint32_t agent = 0; agent < count; ++agent) add_copy(fleet, one, agent);
  return fleet;
}

std::vector<Formula> each(std::uint32_t count, std::uint32_t place) {
  std::vector<Formula> all;
  for (std::uint32_t agent = 0; agent < count; ++agent) all.push_back(Formula::marked({2 * agent + place}));
  return all;
}

TEST(Goals, EqualAgentsAreExploredOnce) {
  const net::Net fleet = walkers(200, true);
  std::vector<Goal> goals;
  for (Formula& one : each(200, 1)) goals.push_back({std::move(one)});
  const std::vector<Found> found =
      ask(fleet, Ask::always_reachable, goals, Kind::no, {true}, {.markings = 1000});
  std::uint64_t states = 0;
  for (const Found& one : found) {
    EXPECT_EQ(one.kind, Kind::yes) << one.why;
    states += one.states;
  }
  EXPECT_LE(states, 2U);
}

TEST(Goals, WhatEachAgentCanReachAllCanReachAtOnce) {
  const Goal at_once{Formula::all(each(60, 1))};
  EXPECT_EQ(ask(walkers(60, true), Ask::always_reachable, {at_once}, Kind::no, {true}, {})[0].kind,
            Kind::yes);
  const net::Net once = walkers(60, false);
  const Found found = ask(once, Ask::reachable, {at_once}, Kind::no, {true}, {})[0];
  EXPECT_EQ(found.kind, Kind::yes);
  EXPECT_EQ(found.trace.size(), 60U);
}

TEST(Goals, OneOfManyIsLostOnlyOnceAllAre) {
  const Goal one_is_left{Formula::any(each(60, 0))};
  EXPECT_EQ(ask(walkers(60, true), Ask::always_reachable, {one_is_left}, Kind::no, {true}, {})[0].kind,
            Kind::yes);
  const Found found = ask(walkers(60, false), Ask::always_reachable, {one_is_left}, Kind::no, {true}, {})[0];
  EXPECT_EQ(found.kind, Kind::no);
  EXPECT_EQ(found.trace.size(), 60U);
}

TEST(Goals, ThoseBehindTheOneThatSettlesItAreLeftOpen) {
  std::vector<Goal> goals;
  for (Formula& one : each(3, 1)) goals.push_back({std::move(one)});
  const std::vector<Found> found = ask(walkers(3, true), Ask::reachable, goals, Kind::yes, {true}, {});
  EXPECT_EQ(found[0].kind, Kind::yes);
  EXPECT_EQ(found[1].kind, Kind::unknown);
}

TEST(Goals, NoTimeMeansUnknown) {
  const Goal goal{Formula::marked({1})};
  const std::vector<Found> found =
      ask(walkers(1, true), Ask::reachable, {goal}, Kind::no, {true}, {.time = std::chrono::seconds(0)});
  EXPECT_EQ(found[0].kind, Kind::unknown);
  EXPECT_NE(found[0].why, "");
}

}  // namespace
}  // namespace tessera::verify
