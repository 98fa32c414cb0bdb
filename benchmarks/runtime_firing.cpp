// What the runtime costs: an iteration of a subsystem without user code, and a value through a channel
// between two threads against what one would write by hand. Figures are in docs/performance.md.

#include <benchmark/benchmark.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "nets.hpp"
#include "test_system.hpp"

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

/// Firings per second of one subsystem that sends to another, all blocks NB -> NB; 8 firings an iteration
/// each.
void iterations(benchmark::State& state, RunOptions::Clock clock, bool recorded) {
  double firings = 0, iterations = 0;
  for (auto _ : state) {
    TestSystem system;
    Script counts;
    counts.call = [](ScriptState& script) {
      if (script.context.iteration == 20'000) script.context.stop("enough");
    };
    const Duration period = clock == RunOptions::Clock::simulated ? Duration(1ms) : Duration(0);
    const auto a = system.add("robot.a", nets::async_sender, counts, period);
    const auto b = system.add("robot.b", nets::async_receiver, counts, period);
    system.connect(a, "x", b, "x", asynchronous);
    RunOptions options = simulated(1h);
    options.clock = clock;
    if (recorded) options.recording = "/dev/null";
    std::string error;
    const auto summary = execute(system.system(), options, error);
    if (!summary) return state.SkipWithError(error.c_str());
    state.SetIterationTime(summary->wall_s);
    firings += static_cast<double>(summary->firings);
    for (const auto& subsystem : summary->subsystems) iterations += static_cast<double>(subsystem.iterations);
  }
  state.counters["firings"] = benchmark::Counter(firings, benchmark::Counter::kIsRate);
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(iterations, simulated, RunOptions::Clock::simulated, false)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(iterations, simulated_recorded, RunOptions::Clock::simulated, true)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(iterations, steady, RunOptions::Clock::steady, false)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// The same exchange by hand: two threads that lock, copy 8 bytes, unlock.
void by_hand_mutex(benchmark::State& state) {
  double exchanges = 0;
  for (auto _ : state) {
    std::mutex mutex;
    double value = 0, sum = 0;
    const auto begin = std::chrono::steady_clock::now();
    std::thread reader([&] {
      for (int round = 0; round < 20'000; ++round) {
        const std::lock_guard lock(mutex);
        sum += value;
      }
    });
    for (int round = 0; round < 20'000; ++round) {
      const std::lock_guard lock(mutex);
      value = round;
    }
    reader.join();
    benchmark::DoNotOptimize(sum);
    state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    exchanges += 40'000;
  }
  state.counters["iterations"] = benchmark::Counter(exchanges, benchmark::Counter::kIsRate);
}
BENCHMARK(by_hand_mutex)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tessera::testing

BENCHMARK_MAIN();
