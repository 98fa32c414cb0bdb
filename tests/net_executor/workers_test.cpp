#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <stdexcept>
#include <thread>

#include "../environment.hpp"
#include "executor_oracle.hpp"

namespace tessera::testing {
namespace {

using End = NetExecutor::End;
using Runs = ExecutableNet::Runs;

TEST(Workers, OperationsOfDifferentPlacesRunAtTheSameTime) {
  std::latch both(2);
  const auto meet = [&] { both.arrive_and_wait(); };  // neither returns unless both run
  ExecutableNet net{
      .places = {{.tokens = 1},
                 {.operation = meet, .runs = Runs::on_worker},
                 {.operation = meet, .runs = Runs::on_worker},
                 {}},
      .transitions = {{.inputs = {{0}}, .outputs = {{1}, {2}}}, {.inputs = {{1}, {2}}, .outputs = {{3}}}}};
  const auto executor = load(net, {.workers = 2});
  EXPECT_EQ(executor->run().end, End::dead);
  EXPECT_EQ(executor->marking(), (Marking{0, 0, 0, 1}));
}

TEST(Workers, TokensOfOnePlaceAreWorkedOnAtTheSameTime) {
  std::latch all(3);
  ExecutableNet net{
      .places = {{.tokens = 3, .operation = [&] { all.arrive_and_wait(); }, .runs = Runs::on_worker}, {}},
      .transitions = {{.inputs = {{0, 3}}, .outputs = {{1}}}}};
  EXPECT_EQ(load(net, {.workers = 3})->run().firings, 1U);
}

TEST(Workers, AnOperationThatRunsEnablesNothingAndHoldsNobodyElseUp) {
  // The slow operation ends only after the ring beside it has turned a hundred times.
  std::latch turned(1);
  std::atomic<bool> slow_ended{false};
  std::uint64_t turns = 0;
  ExecutableNet net{
      .places = {{.tokens = 1,
                  .operation =
                      [&] {
                        turned.wait();
                        slow_ended = true;
                      },
                  .runs = Runs::on_worker},
                 {},
                 {.tokens = 1}},
      .transitions = {{.inputs = {{0}}, .outputs = {{1}}}, {.inputs = {{2}}, .outputs = {{2}}}}};
  NetExecutor* self = nullptr;
  const auto executor = load(net, {.on_firing = [&](std::uint32_t transition) {
                               if (transition == 0) {
                                 EXPECT_TRUE(slow_ended);
                                 self->stop();
                               } else if (++turns == 100) {
                                 turned.count_down();
                               }
                             }});
  self = executor.get();
  EXPECT_EQ(executor->run().end, End::stopped);
  EXPECT_GE(turns, 100U);
  EXPECT_EQ(executor->marking(), (Marking{0, 1, 1}));
}

TEST(Workers, AnExceptionOnAWorkerIsAFaultThatNamesThePlace) {
  bool broken = true;
  ExecutableNet net{.places = {{.name = "grip",
                                .tokens = 1,
                                .operation =
                                    [&] {
                                      if (broken) throw std::runtime_error("slipped");
                                    },
                                .runs = Runs::on_worker},
                               {}},
                    .transitions = {{.inputs = {{0}}, .outputs = {{1}}}}};
  const auto executor = load(net);
  const NetExecutor::Outcome outcome = executor->run();
  EXPECT_EQ(outcome.end, End::fault);
  EXPECT_EQ(outcome.fault, "the operation of place 'grip' threw: slipped");
  broken = false;
  EXPECT_EQ(executor->run().end, End::dead);
  EXPECT_EQ(executor->marking(), (Marking{0, 1}));
}

TEST(Workers, AReconsideredConditionWakesARunThatWaitsForAnOperation) {
  std::latch fired(1);
  std::atomic<bool> open{false};
  NetExecutor* self = nullptr;
  ExecutableNet net{
      .places = {{.tokens = 1},
                 {},
                 {.tokens = 1,
                  .operation =
                      [&] {
                        open = true;
                        self->reconsider();
                        fired.wait();
                      },
                  .runs = Runs::on_worker}},
      .transitions = {{.inputs = {{0}}, .outputs = {{1}}, .condition = [&] { return open.load(); }}}};
  const auto executor = load(net, {.on_firing = [&](std::uint32_t) { fired.count_down(); }});
  self = executor.get();
  EXPECT_EQ(executor->run().end, End::dead);
}

/// Some places get operations, inline or on workers; each counts the finished ones. A token may be taken only
/// when an operation of its place has finished for it.
TEST(Workers, RandomNetsFireLegallyAndWaitForTheirOperations) {
  const std::uint64_t nets = from_environment("TESSERA_RANDOM_NETS", share_of(3000)) / 10;
  std::uint64_t operations = 0;
  for (std::uint32_t seed = 0; seed < nets && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    ExecutableNet net = random_net(random);
    const auto finished = std::make_unique<std::atomic<std::uint32_t>[]>(net.places.size());
    for (std::size_t place = 0; place < net.places.size(); ++place) {
      if (random() % 2 == 0) continue;
      net.places[place].operation = [count = &finished[place]] { ++*count; };
      net.places[place].runs = random() % 3 == 0 ? Runs::inline_with_firing : Runs::on_worker;
    }
    NaiveRun naive(net);
    std::vector<std::uint32_t> taken(net.places.size(), 0);
    NetExecutor::Options options{.seed = seed, .workers = 1 + seed % 3, .bound = 20};
    options.ties = seed % 2 == 0 ? NetExecutor::Ties::fair : NetExecutor::Ties::random;
    options.on_firing = [&](std::uint32_t transition) {
      EXPECT_TRUE(naive.fire(transition));
      for (const ExecutableNet::Arc& arc : net.transitions[transition].inputs) {
        taken[arc.place] += arc.weight;
        if (net.places[arc.place].operation) {
          EXPECT_LE(taken[arc.place], finished[arc.place]);
        }
      }
    };
    const auto executor = load(net, options);
    const NetExecutor::Outcome outcome = executor->run(100);
    EXPECT_EQ(executor->marking(), naive.marking());
    if (outcome.end == End::dead) {
      EXPECT_TRUE(naive.enabled().empty());
    }
    for (std::size_t place = 0; place < net.places.size(); ++place) operations += finished[place];
  }
  EXPECT_GT(operations, (sanitized ? 4 : 5) * nets);
}

}  // namespace
}  // namespace tessera::testing
