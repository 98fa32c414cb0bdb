// Measures how well the subsystem executor keeps periods, beside a thread that only sleeps until the next
// one, and the cost of recording a million events a second. The compared programs take turns in the same run;
// counters are medians over the repetitions. Figures are in docs/inside/performance.md.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "recorder/recorder.hpp"
#include "robots.hpp"

using namespace std::chrono_literals;

namespace tessera::benchmarks {
namespace {

constexpr int rounds = 5;
constexpr std::int64_t period_ns = 1'000'000;
constexpr std::size_t periods = 2'000;

// -------------------------------------------------------------------------------------------- lateness

struct Lateness {
  double p50_us, p99_us;
};

[[nodiscard]] Lateness lateness_of(std::vector<std::int64_t> ns) {
  std::sort(ns.begin(), ns.end());
  return {static_cast<double>(ns[ns.size() / 2]) * 1e-3,
          static_cast<double>(ns[ns.size() * 99 / 100]) * 1e-3};
}

[[nodiscard]] Lateness by_tessera() {
  std::vector<std::int64_t> ns;
  ns.reserve(periods);
  Robot robot([&](std::uint32_t, Context& context) {
    // The first call comes at once.
    if (context.iteration > 0) ns.push_back(context.now.time_since_epoch().count() % period_ns);
    if (ns.size() == periods) context.stop("enough");
  });
  robot.add(nets::alone, 1ms);
  robot.run();
  return lateness_of(std::move(ns));
}

[[nodiscard]] Lateness by_nanosleep() {
  std::vector<std::int64_t> ns;
  ns.reserve(periods);
  for (std::int64_t next = wall_ns() + period_ns; ns.size() < periods; next += period_ns) {
    const timespec until{.tv_sec = next / 1'000'000'000, .tv_nsec = next % 1'000'000'000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    ns.push_back(std::max<std::int64_t>(wall_ns() - next, 0) % period_ns);
  }
  return lateness_of(std::move(ns));
}

void lateness_at_1_kHz(benchmark::State& state) {
  std::vector<double> p50, p99, bare_p50, bare_p99, to_p50, to_p99;
  for (auto _ : state) {
    const Lateness bare = by_nanosleep(), own = by_tessera();
    p50.push_back(own.p50_us);
    p99.push_back(own.p99_us);
    bare_p50.push_back(bare.p50_us);
    bare_p99.push_back(bare.p99_us);
    to_p50.push_back(own.p50_us / bare.p50_us);
    to_p99.push_back(own.p99_us / bare.p99_us);
    state.SetIterationTime(own.p50_us * 1e-6);
  }
  state.counters["p50_us"] = median(p50);
  state.counters["p99_us"] = median(p99);
  state.counters["bare_p50_us"] = median(bare_p50);
  state.counters["bare_p99_us"] = median(bare_p99);
  state.counters["ratio_p50"] = median(to_p50);
  state.counters["ratio_p99"] = median(to_p99);
}
BENCHMARK(lateness_at_1_kHz)->UseManualTime()->Iterations(rounds);

// -------------------------------------------------------------------------------------------- many at once

/// 200 subsystems at 100 Hz: how many of the releases were kept, and the CPU time as a share of one core.
void two_hundred_at_100_Hz(benchmark::State& state) {
  std::vector<double> cpu, kept, missed;
  for (auto _ : state) {
    Robot robot({});
    for (int part = 0; part < 200; ++part) robot.add(nets::alone, 10ms);
    RunOptions options;
    options.duration = 3s;
    const std::int64_t begin_ns = process_cpu_ns();
    const RunSummary summary = robot.run(options);
    cpu.push_back(static_cast<double>(process_cpu_ns() - begin_ns) * 1e-9 / summary.wall_s);
    double iterations = 0, overruns = 0;
    for (const auto& subsystem : summary.subsystems) {
      iterations += static_cast<double>(subsystem.iterations);
      overruns += static_cast<double>(subsystem.overruns);
    }
    missed.push_back(overruns);
    kept.push_back(iterations / (200.0 * seconds(summary.simulated) * 100.0));
    state.SetIterationTime(summary.wall_s);
  }
  state.counters["cores"] = median(cpu);
  state.counters["kept"] = median(kept);
  state.counters["missed"] = median(missed);  // instants passed over while the subsystem was running
}
BENCHMARK(two_hundred_at_100_Hz)->UseManualTime()->Iterations(rounds);

// -------------------------------------------------------------------------------------------- recording

/// Records an event, with its time, like the executor: a million times a second for ten seconds.
void recording(benchmark::State& state) {
  constexpr std::uint32_t burst = 1'000;
  constexpr int bursts = 10'000;
  const std::string file = std::filesystem::temp_directory_path() / ("bench." + std::to_string(getpid()));
  double lost = 0;
  std::int64_t spent_ns = 0;
  for (auto _ : state) {
    std::string error;
    const auto recorder = Recorder::open(file, {"{}"}, 1, Recorder::Mode::threaded, error);
    if (recorder == nullptr) return state.SkipWithError(error.c_str());
    RecordingLane& lane = *recorder->lane(0);
    const std::int64_t begin_ns = wall_ns();
    for (int round = 1; round <= bursts; ++round) {
      const std::int64_t cpu_ns = thread_cpu_ns();
      for (std::uint32_t event = 0; event < burst; ++event)
        lane.firing(Time(Duration(wall_ns())), event, event);
      spent_ns += thread_cpu_ns() - cpu_ns;
      const std::int64_t next = begin_ns + round * period_ns;
      const timespec until{.tv_sec = next / 1'000'000'000, .tv_nsec = next % 1'000'000'000};
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    }
    state.SetIterationTime(static_cast<double>(wall_ns() - begin_ns) * 1e-9);
    lost += static_cast<double>(recorder->close().lost);
  }
  std::filesystem::remove(file);
  state.counters["event_ns"] =
      static_cast<double>(spent_ns) / (static_cast<double>(state.iterations()) * burst * bursts);
  state.counters["lost"] = lost;
}
BENCHMARK(recording)->UseManualTime()->Iterations(1);

}  // namespace
}  // namespace tessera::benchmarks

BENCHMARK_MAIN();
