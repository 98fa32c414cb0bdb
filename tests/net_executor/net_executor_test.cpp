#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "executor_oracle.hpp"

namespace tessera::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using End = NetExecutor::End;

/// One token in `a`; one transition per entry, from a to a place of its own.
[[nodiscard]] ExecutableNet choice(std::uint32_t ways) {
  ExecutableNet net;
  net.places.push_back({.name = "a", .tokens = 1});
  for (std::uint32_t way = 1; way <= ways; ++way) {
    net.places.push_back({.name = "to" + std::to_string(way)});
    net.transitions.push_back({.name = "t" + std::to_string(way), .inputs = {{0}}, .outputs = {{way}}});
  }
  return net;
}

/// a -> t1 -> b -> t2 -> a, one token in a.
[[nodiscard]] ExecutableNet ring_of_two() {
  return {.places = {{.name = "a", .tokens = 1}, {.name = "b"}},
          .transitions = {{.name = "t1", .inputs = {{0}}, .outputs = {{1}}},
                          {.name = "t2", .inputs = {{1}}, .outputs = {{0}}}}};
}

TEST(NetExecutor, WeightsTakeAndGiveThatManyTokens) {
  ExecutableNet net{.places = {{.tokens = 7}, {}},
                    .transitions = {{.inputs = {{0, 3}}, .outputs = {{1, 2}}}}};
  const auto executor = load(net);
  const NetExecutor::Outcome outcome = executor->run();
  EXPECT_EQ(outcome.end, End::dead);
  EXPECT_EQ(outcome.firings, 2U);
  EXPECT_THAT(executor->marking(), ElementsAre(1U, 4U));
}

TEST(NetExecutor, ArcsWithTheSamePlaceAddUp) {
  ExecutableNet net{.places = {{.tokens = 3}, {}},
                    .transitions = {{.inputs = {{0}, {0}}, .outputs = {{1}, {1}}}}};
  const auto executor = load(net);
  EXPECT_EQ(executor->run().firings, 1U);
  EXPECT_THAT(executor->marking(), ElementsAre(1U, 2U));
}

TEST(NetExecutor, ALaterRunGoesOnWhereTheLastOneEnded) {
  const auto executor = load(ring_of_two());
  EXPECT_EQ(executor->run(3).end, End::limit);
  EXPECT_THAT(executor->marking(), ElementsAre(0U, 1U));
  EXPECT_EQ(executor->run(1).firings, 1U);
  EXPECT_THAT(executor->marking(), ElementsAre(1U, 0U));
  EXPECT_EQ(executor->run(0).firings, 0U);
}

TEST(NetExecutor, ANetWithoutTransitionsIsDead) {
  EXPECT_EQ(load({})->run().end, End::dead);
  EXPECT_EQ(load({.places = {{.tokens = 1}}, .transitions = {}})->run().end, End::dead);
}

TEST(NetExecutor, HigherPriorityGoesFirst) {
  ExecutableNet net = choice(3);
  net.transitions[1].priority = 5;
  net.transitions[2].priority = -5;
  const auto executor = load(net);
  EXPECT_EQ(executor->run().firings, 1U);
  EXPECT_THAT(executor->marking(), ElementsAre(0U, 0U, 1U, 0U));
}

TEST(NetExecutor, AHundredPrioritiesAreKeptApart) {
  ExecutableNet net;
  std::vector<std::uint32_t> fired, expected;
  for (std::uint32_t i = 0; i < 100; ++i) {
    net.places.push_back({.tokens = 1});
    net.transitions.push_back({.inputs = {{i}}, .priority = static_cast<std::int32_t>(i * 37 % 100)});
  }
  const auto executor = load(net, {.on_firing = [&](std::uint32_t t) { fired.push_back(t); }});
  EXPECT_EQ(executor->run().firings, 100U);
  EXPECT_TRUE(std::ranges::is_sorted(fired, std::greater<>(),
                                     [&](std::uint32_t t) { return net.transitions[t].priority; }));
}

TEST(NetExecutor, FairTiesTakeTurns) {
  ExecutableNet net{.places = {{.tokens = 1}}, .transitions = {}};
  for (int i = 0; i < 5; ++i) net.transitions.push_back({.inputs = {{0}}, .outputs = {{0}}});
  std::vector<std::uint32_t> times(5, 0);
  const auto executor = load(net, {.on_firing = [&](std::uint32_t t) { ++times[t]; }});
  EXPECT_EQ(executor->run(1000).firings, 1000U);
  EXPECT_THAT(times, ::testing::Each(200U));
}

TEST(NetExecutor, TiesByLotGiveEachTheSameChanceAndRepeatFromTheSeed) {
  ExecutableNet net{.places = {{.tokens = 1}}, .transitions = {}};
  for (int i = 0; i < 5; ++i) net.transitions.push_back({.inputs = {{0}}, .outputs = {{0}}});
  const auto play = [&](std::uint64_t seed) {
    std::vector<std::uint32_t> fired;
    const auto executor =
        load(net, {.ties = NetExecutor::Ties::random, .seed = seed, .on_firing = [&](std::uint32_t t) {
                     fired.push_back(t);
                   }});
    EXPECT_EQ(executor->run(5000).firings, 5000U);
    return fired;
  };
  const std::vector<std::uint32_t> fired = play(1);
  EXPECT_EQ(fired, play(1));
  EXPECT_NE(fired, play(2));
  for (std::uint32_t t = 0; t < 5; ++t)
    EXPECT_NEAR(static_cast<double>(std::ranges::count(fired, t)), 1000, 150);
}

// ---------------------------------------------------------------------------------------------- conditions

TEST(NetExecutor, ATransitionWithAFalseConditionStepsAside) {
  ExecutableNet net = choice(2);
  net.transitions[0].condition = [] { return false; };
  const auto executor = load(net);
  EXPECT_EQ(executor->run().end, End::dead);
  EXPECT_THAT(executor->marking(), ElementsAre(0U, 0U, 1U));
}

TEST(NetExecutor, BlockedUntilConditionsAreReconsidered) {
  ExecutableNet net = choice(1);
  bool open = false;
  int asked = 0;
  net.transitions[0].condition = [&] { return ++asked, open; };
  const auto executor = load(net);
  EXPECT_EQ(executor->run().end, End::blocked);
  open = true;
  EXPECT_EQ(executor->run().end, End::blocked);
  EXPECT_EQ(asked, 1);
  executor->reconsider();
  EXPECT_EQ(executor->run().end, End::dead);
  EXPECT_EQ(asked, 2);
  EXPECT_THAT(executor->marking(), ElementsAre(0U, 1U));
}

TEST(NetExecutor, AnArrivingTokenAsksTheConditionAgain) {
  // t: a -> b [third time]; feed: c -> a, with three tokens in c.
  int asked = 0;
  ExecutableNet net{
      .places = {{.name = "a"}, {.name = "b"}, {.name = "c", .tokens = 3}},
      .transitions = {{.inputs = {{0}}, .outputs = {{1}}, .condition = [&] { return ++asked == 3; }},
                      {.inputs = {{2}}, .outputs = {{0}}}}};
  const auto executor = load(net);
  // The firing leaves two tokens in a, for which the condition is asked a fourth time.
  EXPECT_EQ(executor->run().end, End::blocked);
  EXPECT_EQ(asked, 4);
  EXPECT_THAT(executor->marking(), ElementsAre(2U, 1U, 0U));
}

TEST(NetExecutor, AThrowingConditionIsAFaultThatNamesTheTransition) {
  ExecutableNet net = choice(1);
  bool broken = true;
  net.transitions[0].condition = [&] {
    if (broken) throw std::runtime_error("no light");
    return true;
  };
  const auto executor = load(net);
  const NetExecutor::Outcome outcome = executor->run();
  EXPECT_EQ(outcome.end, End::fault);
  EXPECT_EQ(outcome.fault, "the condition of transition 't1' threw: no light");
  EXPECT_THAT(executor->marking(), ElementsAre(1U, 0U));
  EXPECT_EQ(executor->run().fault, outcome.fault);
  broken = false;
  EXPECT_EQ(executor->run().end, End::dead);
}

// ---------------------------------------------------------------------------------------------- operations

TEST(NetExecutor, EveryTokenStartsTheOperationOfItsPlace) {
  int calls = 0;
  ExecutableNet net{.places = {{.tokens = 1, .operation = {}}, {.tokens = 2, .operation = [&] { ++calls; }}},
                    .transitions = {{.inputs = {{0}}, .outputs = {{1, 3}}}}};
  const auto executor = load(net);
  EXPECT_EQ(executor->run().end, End::dead);
  EXPECT_EQ(calls, 5);
  EXPECT_THAT(executor->marking(), ElementsAre(0U, 5U));
}

TEST(NetExecutor, AThrowingOperationIsAFaultAndStartsAgainWithTheNextRun) {
  ExecutableNet net = ring_of_two();
  int calls = 0;
  net.places[1].operation = [&] {
    if (++calls == 3) throw std::runtime_error("no grip");
  };
  const auto executor = load(net);
  const NetExecutor::Outcome outcome = executor->run();
  EXPECT_EQ(outcome.end, End::fault);
  EXPECT_EQ(outcome.firings, 5U);
  EXPECT_EQ(outcome.fault, "the operation of place 'b' threw: no grip");
  EXPECT_THAT(executor->marking(), ElementsAre(0U, 1U));
  EXPECT_TRUE(executor->enabled().empty()) << "its token is not finished";
  EXPECT_EQ(executor->run(1).firings, 1U);
  EXPECT_EQ(calls, 4);
}

TEST(NetExecutor, WhatIsNoExceptionIsReportedToo) {
  ExecutableNet net = ring_of_two();
  net.places[1].operation = [] { throw 1; };
  EXPECT_THAT(load(net)->run().fault, HasSubstr("place 'b' threw something"));
}

TEST(NetExecutor, AnOperationMayStopTheRun) {
  ExecutableNet net = ring_of_two();
  NetExecutor* self = nullptr;
  net.places[1].operation = [&] { self->stop(); };
  const auto executor = load(net);
  self = executor.get();
  for (std::uint64_t firings : {1U, 2U, 2U}) {
    const NetExecutor::Outcome outcome = executor->run();
    EXPECT_EQ(outcome.end, End::stopped);
    EXPECT_EQ(outcome.firings, firings);
  }
}

// ---------------------------------------------------------------------------------------------- limits

TEST(NetExecutor, MoreTokensThanTheBoundAreAFaultAndTheFiringIsNotMade) {
  ExecutableNet net{.places = {{.name = "a", .tokens = 1}, {.name = "heap"}},
                    .transitions = {{.inputs = {{0}}, .outputs = {{0}, {1}}}}};
  const auto executor = load(net, {.bound = 10});
  const NetExecutor::Outcome outcome = executor->run(100);
  EXPECT_EQ(outcome.end, End::fault);
  EXPECT_EQ(outcome.fault, "place 'heap' would hold more than 10 tokens");
  EXPECT_EQ(outcome.firings, 10U);
  EXPECT_EQ(executor->run(100).fault, outcome.fault);
  EXPECT_THAT(executor->marking(), ElementsAre(1U, 10U));
}

TEST(NetExecutor, TheBoundHoldsOnDirectFiringsToo) {
  ExecutableNet net = ring_of_two();
  net.places[0].tokens = 2;
  net.places[1].tokens = 2;
  const auto executor = load(net, {.bound = 2});
  const NetExecutor::Outcome outcome = executor->run();
  EXPECT_EQ(outcome.end, End::fault);
  EXPECT_EQ(outcome.fault, "place 'b' would hold more than 2 tokens");
  EXPECT_THAT(executor->marking(), ElementsAre(2U, 2U));
}

TEST(NetExecutor, WrongNetsAreRefusedWithTheName) {
  std::string error;
  const auto refused = [&](ExecutableNet net) {
    return NetExecutor::load(std::move(net), {}, error) == nullptr;
  };
  ExecutableNet net = choice(2);
  net.transitions[1].outputs[0].place = 3;
  EXPECT_TRUE(refused(net));
  EXPECT_THAT(error, HasSubstr("transition 't2'"));
  net = choice(2);
  net.transitions[0].inputs[0].weight = 0;
  EXPECT_TRUE(refused(net));
  EXPECT_THAT(error, HasSubstr("transition 't1'"));
  net = choice(2);
  net.transitions[0].inputs = {{0, UINT32_MAX / 2}, {0, UINT32_MAX / 2}};
  EXPECT_TRUE(refused(net));
  net = choice(2);
  net.places[0].tokens = UINT32_MAX;
  EXPECT_TRUE(refused(net));
  EXPECT_THAT(error, HasSubstr("place 'a'"));
}

}  // namespace
}  // namespace tessera::testing
