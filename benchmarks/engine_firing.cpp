// Measures a firing of a NetExecutor, on nets of different sizes, beside a hand-written ring with tables in
// the same program. Figures are in docs/inside/performance.md.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <bit>
#include <ctime>
#include <random>

#include "tessera/net_executor.hpp"

namespace tessera {
namespace {

/// `rings` rings of `places` places with one token each.
[[nodiscard]] ExecutableNet rings_of(std::uint32_t rings, std::uint32_t places) {
  ExecutableNet net;
  net.places.resize(std::size_t{rings} * places);
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    for (std::uint32_t i = 0; i < places; ++i) {
      const std::uint32_t first = ring * places;
      if (i == 0) net.places[first].tokens = 1;
      net.transitions.push_back({.inputs = {{first + i}}, .outputs = {{first + (i + 1) % places}}});
    }
  return net;
}

/// The same net with its elements in random order.
[[nodiscard]] ExecutableNet shuffled(const ExecutableNet& net) {
  std::vector<std::uint32_t> where(net.places.size());
  for (std::uint32_t i = 0; i < where.size(); ++i) where[i] = i;
  std::mt19937 random(1);
  std::shuffle(where.begin(), where.end(), random);
  ExecutableNet result = net;
  for (std::uint32_t i = 0; i < where.size(); ++i) result.places[where[i]] = net.places[i];
  for (ExecutableNet::Transition& transition : result.transitions)
    for (auto* arcs : {&transition.inputs, &transition.outputs})
      for (ExecutableNet::Arc& arc : *arcs) arc.place = where[arc.place];
  std::shuffle(result.transitions.begin(), result.transitions.end(), random);
  return result;
}

/// A source forks to `width` places, which a join collects: two firings of width + 1 arcs each.
[[nodiscard]] ExecutableNet fork_and_join(std::uint32_t width) {
  ExecutableNet net;
  net.places.resize(width + 1);
  net.places[0].tokens = 1;
  net.transitions = {{.inputs = {{0}}}, {.outputs = {{0}}}};
  for (std::uint32_t i = 1; i <= width; ++i) {
    net.transitions[0].outputs.push_back({i});
    net.transitions[1].inputs.push_back({i});
  }
  return net;
}

/// Philosophers that take both forks at once: many conflicts.
[[nodiscard]] ExecutableNet philosophers(std::uint32_t count) {
  ExecutableNet net;
  net.places.resize(std::size_t{count} * 3);  // thinking, eating, fork
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t thinking = 3 * i, eating = 3 * i + 1, left = 3 * i + 2,
                        right = 3 * ((i + 1) % count) + 2;
    net.places[thinking].tokens = net.places[left].tokens = 1;
    net.transitions.push_back({.inputs = {{thinking}, {left}, {right}}, .outputs = {{eating}}});
    net.transitions.push_back({.inputs = {{eating}}, .outputs = {{thinking}, {left}, {right}}});
  }
  return net;
}

/// A hand-written ring: tables, a marking, and a queue of the enabled transitions.
class RingByHand {
 public:
  explicit RingByHand(std::uint32_t size)
      : from_(size), to_(size), taker_(size), marking_(size, 0), queue_(std::bit_ceil(size)) {
    for (std::uint32_t i = 0; i < size; ++i) {
      from_[i] = taker_[i] = i;
      to_[i] = (i + 1) % size;
    }
    marking_[0] = 1;
  }
  std::uint64_t run(std::uint64_t most) {
    const auto mask = static_cast<std::uint32_t>(queue_.size() - 1);
    std::uint64_t firings = 0;
    while (firings < most && first_ != end_) {
      const std::uint32_t transition = queue_[first_++ & mask];
      if (marking_[from_[transition]] == 0) continue;
      --marking_[from_[transition]];
      ++marking_[to_[transition]];
      queue_[end_++ & mask] = taker_[to_[transition]];
      ++firings;
    }
    return firings;
  }

 private:
  std::vector<std::uint32_t> from_, to_, taker_, marking_, queue_;
  std::uint32_t first_ = 0, end_ = 1;
};

constexpr std::uint64_t firings_at_once = 1'000'000;

[[nodiscard]] double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU time of a firing, and its ratio to a firing of RingByHand of ten places, which takes turns with it.
void fire(benchmark::State& state, ExecutableNet net, NetExecutor::Options options = {}) {
  std::string error;
  const auto executor = NetExecutor::load(std::move(net), std::move(options), error);
  if (executor->run(firings_at_once).firings != firings_at_once)
    return state.SkipWithError("it does not fire for ever");
  RingByHand by_hand(10);
  double own = 0, hand = 0;
  std::uint64_t firings = 0;
  for (auto _ : state) {
    const double start = cpu_seconds();
    firings += executor->run(firings_at_once).firings;
    const double middle = cpu_seconds();
    benchmark::DoNotOptimize(by_hand.run(firings_at_once));
    hand += cpu_seconds() - middle;
    own += middle - start;
    state.SetIterationTime(middle - start);
  }
  state.counters["firing"] = own / static_cast<double>(firings);
  state.counters["by_hand"] = hand / static_cast<double>(firings);
  state.counters["ratio"] = own / hand;
}

void ring(benchmark::State& state) { fire(state, rings_of(1, static_cast<std::uint32_t>(state.range(0)))); }
void independent_rings(benchmark::State& state) { fire(state, rings_of(1000, 10)); }
void shuffled_ring(benchmark::State& state) { fire(state, shuffled(rings_of(1, 100'000))); }
void forks_and_joins(benchmark::State& state) {
  fire(state, fork_and_join(static_cast<std::uint32_t>(state.range(0))));
}
void dining(benchmark::State& state) {
  fire(state, philosophers(static_cast<std::uint32_t>(state.range(0))));
}
void dining_by_lot(benchmark::State& state) {
  fire(state, philosophers(1000), {.ties = NetExecutor::Ties::random});
}

void load_shuffled_ring(benchmark::State& state) {
  const ExecutableNet net = shuffled(rings_of(1, 100'000));
  for (auto _ : state) {
    std::string error;
    benchmark::DoNotOptimize(NetExecutor::load(net, {}, error));
  }
}

BENCHMARK(ring)->RangeMultiplier(10)->Range(10, 100'000)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(independent_rings)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(shuffled_ring)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(forks_and_joins)->Arg(2)->Arg(10)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(dining)->Arg(10)->Arg(1000)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(dining_by_lot)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(load_shuffled_ring)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tessera

BENCHMARK_MAIN();
