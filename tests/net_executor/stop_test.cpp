#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "../environment.hpp"
#include "executor_oracle.hpp"

// TESSERA_STOPS asks for more stops than an everyday run makes.

namespace tessera::testing {
namespace {

using End = NetExecutor::End;
using Runs = ExecutableNet::Runs;

/// Two rings of three, one with operations: inline, on a worker, none.
[[nodiscard]] ExecutableNet busy_net(std::atomic<std::uint64_t>& work) {
  const auto operation = [&work] { ++work; };
  ExecutableNet net;
  for (std::uint32_t ring = 0; ring < 2; ++ring) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      ExecutableNet::Place place{.tokens = i == 0 ? 2U : 0U};
      if (ring == 1 && i > 0) place.operation = operation;
      if (ring == 1 && i > 1) place.runs = Runs::on_worker;
      net.places.push_back(std::move(place));
      net.transitions.push_back({.inputs = {{3 * ring + i}}, .outputs = {{3 * ring + (i + 1) % 3}}});
    }
  }
  return net;
}

/// A thread that stops the run whenever it is asked to, after a random number of turns of an empty loop.
class Stopper {
 public:
  explicit Stopper(NetExecutor& executor) : thread_([this, &executor] { work(executor); }) {}
  ~Stopper() {
    asked_ = done;
    asked_.notify_one();
    thread_.join();
  }
  Stopper(const Stopper&) = delete;
  Stopper& operator=(const Stopper&) = delete;
  void stop_after(std::int32_t turns) {
    asked_ = turns;
    asked_.notify_one();
  }

 private:
  static constexpr std::int32_t none = -1, done = -2;
  void work(NetExecutor& executor) {
    for (;;) {
      asked_.wait(none);
      const std::int32_t turns = asked_.exchange(none);
      if (turns == done) return;
      for (std::int32_t turn = 0; turn < turns; ++turn) std::atomic_signal_fence(std::memory_order_seq_cst);
      executor.stop();
    }
  }
  std::atomic<std::int32_t> asked_{none};
  std::thread thread_;
};

void stop_at_random_moments(ExecutableNet net, std::uint64_t stops) {
  const std::uint32_t tokens = 4;
  const auto executor = load(std::move(net), {.workers = 2});
  Stopper stopper(*executor);
  Random random(1);
  std::uint64_t firings = 0;
  // On a busy machine, many runs are stopped before a transition fires: further runs make up for them.
  for (std::uint64_t stop = 0; stop < stops || (firings <= stops && stop < 100 * stops); ++stop) {
    stopper.stop_after(static_cast<std::int32_t>(random() % 20'000));
    const NetExecutor::Outcome outcome = executor->run();
    ASSERT_EQ(outcome.end, End::stopped);
    firings += outcome.firings;
    std::uint32_t sum = 0;
    for (const std::uint32_t count : executor->marking()) sum += count;
    ASSERT_EQ(sum, tokens) << "no token gets lost over a stop";
  }
  EXPECT_GT(firings, stops);
}

TEST(Stop, AtAnyMomentEndsARunThatFiresAndWorks) {
  std::atomic<std::uint64_t> work{0};
  stop_at_random_moments(busy_net(work), from_environment("TESSERA_STOPS", share_of(1000)));
  EXPECT_GT(work, 0U);
}

TEST(Stop, AtAnyMomentEndsARunThatSleepsBetweenOperations) {
  // No transition can fire while the workers work: the run sleeps most of the time.
  std::atomic<std::uint64_t> work{0};
  ExecutableNet net{.places = {{.tokens = 4, .operation = [&] { ++work; }, .runs = Runs::on_worker}},
                    .transitions = {{.inputs = {{0}}, .outputs = {{0}}}}};
  stop_at_random_moments(net, from_environment("TESSERA_STOPS", share_of(1000)));
  EXPECT_GT(work, 0U);
}

TEST(Stop, WithoutARunEndsTheNextOne) {
  const auto executor =
      load({.places = {{.tokens = 1}}, .transitions = {{.inputs = {{0}}, .outputs = {{0}}}}});
  executor->stop();
  NetExecutor::Outcome outcome = executor->run();
  EXPECT_EQ(outcome.end, End::stopped);
  EXPECT_EQ(outcome.firings, 0U);
  EXPECT_EQ(executor->run(5).end, End::limit);
}

TEST(Stop, WaitsForTheOperationThatRunsAndBeginsNoOther) {
  std::atomic<int> begun{0}, ended{0};
  NetExecutor* self = nullptr;
  ExecutableNet net{.places = {{.tokens = 3,
                                .operation =
                                    [&] {
                                      if (++begun == 1) self->stop();
                                      ++ended;
                                    },
                                .runs = Runs::on_worker}},
                    .transitions = {}};
  const auto executor = load(net, {.workers = 1});
  self = executor.get();
  EXPECT_EQ(executor->run().end, End::stopped);
  EXPECT_EQ(begun, ended);
  EXPECT_EQ(executor->run().end, End::dead);
  EXPECT_EQ(ended, 3);
}

NetExecutor* interrupted = nullptr;

TEST(Stop, WorksFromASignalHandler) {
  const auto executor = load({.places = {{.tokens = 1, .operation = [] { std::raise(SIGUSR1); }}},
                              .transitions = {{.inputs = {{0}}, .outputs = {{0}}}}});
  interrupted = executor.get();
  const auto before = std::signal(SIGUSR1, [](int) { interrupted->stop(); });
  EXPECT_EQ(executor->run().end, End::stopped);
  std::signal(SIGUSR1, before);
}

}  // namespace
}  // namespace tessera::testing
