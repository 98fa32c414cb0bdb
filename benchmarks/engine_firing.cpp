// What a firing of a NetExecutor costs, on nets of different sizes, beside a ring played from tables by hand
// in the same program. Figures are in docs/performance.md.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <bit>
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

/// The same net with its elements written down in any order.
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

/// Philosophers that take both forks at once: conflicts everywhere.
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

constexpr std::uint64_t firings_at_once = 1'000'000;

void fire(benchmark::State& state, ExecutableNet net, NetExecutor::Options options = {}) {
  std::string error;
  const auto executor = NetExecutor::load(std::move(net), std::move(options), error);
  std::uint64_t firings = executor->run(firings_at_once).firings;
  if (firings != firings_at_once) return state.SkipWithError("it does not fire for ever");
  firings = 0;
  for (auto _ : state) firings += executor->run(firings_at_once).firings;
  state.counters["ns_a_firing"] = benchmark::Counter(
      static_cast<double>(firings), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// What one would write by hand: tables, a marking, and a queue of the enabled transitions.
void by_hand(benchmark::State& state) {
  const auto size = static_cast<std::uint32_t>(state.range(0));
  std::vector<std::uint32_t> from(size), to(size), taker(size), marking(size, 0);
  for (std::uint32_t i = 0; i < size; ++i) {
    from[i] = i;
    to[i] = (i + 1) % size;
    taker[i] = i;
  }
  std::vector<std::uint32_t> queue(std::bit_ceil(size));
  const std::uint32_t mask = static_cast<std::uint32_t>(queue.size() - 1);
  std::uint32_t first = 0, end = 1;
  marking[0] = 1;
  std::uint64_t firings = 0;
  for (auto _ : state)
    for (std::uint64_t left = firings_at_once; left > 0; --left) {
      const std::uint32_t transition = queue[first++ & mask];
      if (marking[from[transition]] == 0) continue;
      --marking[from[transition]];
      ++marking[to[transition]];
      queue[end++ & mask] = taker[to[transition]];
      ++firings;
      benchmark::ClobberMemory();
    }
  state.counters["ns_a_firing"] = benchmark::Counter(
      static_cast<double>(firings), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void ring(benchmark::State& state) { fire(state, rings_of(1, static_cast<std::uint32_t>(state.range(0)))); }
void independent_rings(benchmark::State& state) { fire(state, rings_of(1000, 10)); }
void shuffled_ring(benchmark::State& state) { fire(state, shuffled(rings_of(1, 100'000))); }
void forks_and_joins(benchmark::State& state) {
  fire(state, fork_and_join(static_cast<std::uint32_t>(state.range(0))));
}
void dining(benchmark::State& state) { fire(state, philosophers(1000)); }
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

BENCHMARK(by_hand)->Arg(10)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(ring)->RangeMultiplier(10)->Range(10, 100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(independent_rings)->Unit(benchmark::kMillisecond);
BENCHMARK(shuffled_ring)->Unit(benchmark::kMillisecond);
BENCHMARK(forks_and_joins)->Arg(2)->Arg(10)->Unit(benchmark::kMillisecond);
BENCHMARK(dining)->Unit(benchmark::kMillisecond);
BENCHMARK(dining_by_lot)->Unit(benchmark::kMillisecond);
BENCHMARK(load_shuffled_ring)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tessera

BENCHMARK_MAIN();
