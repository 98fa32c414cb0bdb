// Compares the cost of the subsystem executor with hand-written code: an iteration alone, a value through a
// channel between two threads, a blocking round trip. The compared programs take turns in the same run, and
// the counters are medians over the repetitions. docs/inside/performance.md has figures.

#include <benchmark/benchmark.h>
#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>

#include "nets/shared_channel.hpp"
#include "robots.hpp"

using namespace std::chrono_literals;

namespace tessera::benchmarks {
namespace {

constexpr int rounds = 5;
constexpr Duration flat_out = 300ms;

// -------------------------------------------------------------------------------------------- iterations

/// The connections of a subsystem: with itself, all in one thread; or with others, which hardly ever run.
enum class Others : std::uint8_t { none, idle };

/// CPU time of an iteration of a subsystem with empty user code, in ns.
[[nodiscard]] double iteration_ns(const SubsystemNet& net, Others others, bool measures_ages = false) {
  constexpr std::uint64_t warm = 20'000, last = 1'020'000;
  std::int64_t begin = 0, end = 0;
  Robot robot([&](std::uint32_t number, Context& context) {
    if (number != 0) return;
    if (context.iteration == warm) begin = thread_cpu_ns();
    if (context.iteration != last) return;
    end = thread_cpu_ns();
    context.stop("enough");
  });
  const std::uint32_t part = robot.add(net);
  if (!net.ports.empty() && others == Others::none) robot.connect(part, "out", part, "in", asynchronous);
  if (!net.ports.empty() && others == Others::idle) {
    const std::uint32_t to = robot.add(nets::receiver, 1s), from = robot.add(nets::sender, 1s);
    robot.connect(part, "out", to, "x", asynchronous);
    robot.connect(from, "x", part, "in", asynchronous);
  }
  if (measures_ages) robot.measure_ages();
  robot.run();
  return static_cast<double>(end - begin) / static_cast<double>(last - warm);
}

void iteration(benchmark::State& state, const SubsystemNet& net, Others others) {
  std::vector<double> ns;
  for (auto _ : state) {
    ns.push_back(iteration_ns(net, others));
    state.SetIterationTime(ns.back() * 1e-9);
  }
  state.counters["iteration_ns"] = median(ns);
}
BENCHMARK_CAPTURE(iteration, eight_firings, nets::relay, Others::none)->UseManualTime()->Iterations(rounds);
BENCHMARK_CAPTURE(iteration, eight_firings_shared, nets::relay, Others::idle)
    ->UseManualTime()
    ->Iterations(rounds);
BENCHMARK_CAPTURE(iteration, six_firings, nets::alone, Others::none)->UseManualTime()->Iterations(rounds);

/// An iteration in which a reading begins and a command ends, beside the same one without a chain.
void iteration_on_chain(benchmark::State& state) {
  std::vector<double> with, without, ratio;
  for (auto _ : state) {
    without.push_back(iteration_ns(nets::relay, Others::none));
    with.push_back(iteration_ns(nets::relay, Others::none, /*measures_ages=*/true));
    ratio.push_back(with.back() / without.back());
    state.SetIterationTime(with.back() * 1e-9);
  }
  state.counters["iteration_ns"] = median(with);
  state.counters["without_ns"] = median(without);
  state.counters["ratio"] = median(ratio);
}
BENCHMARK(iteration_on_chain)->UseManualTime()->Iterations(rounds);

// -------------------------------------------------------------------------------------------- channels

struct Pair {
  double cycle_ns;  ///< wall time by the cycles of both sides
  double share;     ///< of the slower side
};

[[nodiscard]] Pair pair_of(std::int64_t ns, std::uint64_t one, std::uint64_t other) {
  const auto all = static_cast<double>(one + other);
  return {static_cast<double>(ns) / all, static_cast<double>(std::min(one, other)) / all};
}

/// A sender and a receiver, both without pauses.
[[nodiscard]] Pair by_tessera() {
  Robot robot({});
  const std::uint32_t from = robot.add(nets::sender), to = robot.add(nets::receiver);
  robot.connect(from, "x", to, "x", asynchronous);
  RunOptions options;
  options.duration = flat_out;
  const RunSummary summary = robot.run(options);
  return pair_of(summary.simulated.count(), summary.subsystems[0].iterations,
                 summary.subsystems[1].iterations);
}

/// The channel alone, in the way the executor uses it: take, copy 64 bytes, give back. It sleeps if that
/// takes long.
[[nodiscard]] Pair by_channel() {
  struct Words final : Waker {
    std::array<WakeWord, 2> words;
    void wake(std::uint32_t instance) override { words[instance].wake(); }
  } waker;
  SharedChannel channel(1, sizeof(Payload));
  channel.connect(Side::send, &waker, 0, {1});
  channel.connect(Side::receive, &waker, 1, {1});
  std::atomic<bool> stopping{false};
  std::array<std::uint64_t, 2> cycles{};
  const auto take = [&](Side side) {
    WakeWord& word = waker.words[static_cast<std::size_t>(side)];
    while (channel.fire(side, 1, 0) == 0) {
      if (channel.held() && channel.outwait()) continue;
      const std::uint32_t ticket = word.ticket();
      if (stopping.load(std::memory_order_relaxed)) return false;
      if (channel.wait(side, 1)) word.sleep(ticket, -1);
    }
    return true;
  };
  const auto work = [&](Side side) {
    Payload own{};
    std::uint64_t& count = cycles[static_cast<std::size_t>(side)];
    for (; !stopping.load(std::memory_order_relaxed) && take(side); ++count) {
      own.values[0] += 1;
      std::byte* const shared = channel.memory().bytes.data();
      if (side == Side::send)
        std::memcpy(shared, &own, sizeof own);
      else
        std::memcpy(&own, shared, sizeof own);
      benchmark::DoNotOptimize(own);
      static_cast<void>(channel.fire(side, 0, 1));
    }
  };
  const std::int64_t begin = wall_ns();
  std::thread sender(work, Side::send), receiver(work, Side::receive);
  std::this_thread::sleep_for(flat_out);
  stopping = true;
  for (WakeWord& word : waker.words) word.wake();
  sender.join();
  receiver.join();
  return pair_of(wall_ns() - begin, cycles[0], cycles[1]);
}

/// The same exchange by hand: lock, copy 64 bytes, unlock. timed: the value carries its time of writing, like
/// a buffer's `stamp`, and the reader computes its age, like `age`.
template <bool timed>
[[nodiscard]] Pair by_hand() {
  struct alignas(64) Shared {
    std::mutex mutex;
    Payload value{};
    std::int64_t stamp = 0;
  } shared;
  std::atomic<bool> stopping{false};
  std::array<std::uint64_t, 2> cycles{};
  const auto write = [&] {
    Payload own{};
    for (std::uint64_t& count = cycles[0]; !stopping.load(std::memory_order_relaxed); ++count) {
      own.values[0] += 1;
      const std::int64_t now = timed ? wall_ns() : 0;
      const std::lock_guard lock(shared.mutex);
      shared.value = own;
      shared.stamp = now;
    }
  };
  const auto read = [&] {
    Payload own{};
    std::int64_t oldest = 0;
    for (std::uint64_t& count = cycles[1]; !stopping.load(std::memory_order_relaxed); ++count) {
      std::int64_t stamp = 0;
      {
        const std::lock_guard lock(shared.mutex);
        own = shared.value;
        stamp = shared.stamp;
      }
      if (timed) oldest = std::max(oldest, wall_ns() - stamp);
      benchmark::DoNotOptimize(own);
    }
    benchmark::DoNotOptimize(oldest);
  };
  const std::int64_t begin = wall_ns();
  std::thread writer(write), reader(read);
  std::this_thread::sleep_for(flat_out);
  stopping = true;
  writer.join();
  reader.join();
  return pair_of(wall_ns() - begin, cycles[0], cycles[1]);
}

void channel_cycle(benchmark::State& state) {
  std::vector<double> channel_ns, iteration_ns, mutex_ns, timed_ns, share, iteration_share, ratio, to_timed;
  for (auto _ : state) {
    const Pair mutex = by_hand<false>(), channel = by_channel(), timed = by_hand<true>(), own = by_tessera();
    channel_ns.push_back(channel.cycle_ns);
    share.push_back(channel.share);
    mutex_ns.push_back(mutex.cycle_ns);
    ratio.push_back(channel.cycle_ns / mutex.cycle_ns);
    iteration_ns.push_back(own.cycle_ns);
    iteration_share.push_back(own.share);
    timed_ns.push_back(timed.cycle_ns);
    to_timed.push_back(own.cycle_ns / timed.cycle_ns);
    state.SetIterationTime(channel.cycle_ns * 1e-9);
  }
  state.counters["channel_ns"] = median(channel_ns);
  state.counters["mutex_ns"] = median(mutex_ns);
  state.counters["ratio"] = median(ratio);
  state.counters["share"] = median(share);
  state.counters["iteration_ns"] = median(iteration_ns);
  state.counters["timed_mutex_ns"] = median(timed_ns);
  state.counters["iteration_ratio"] = median(to_timed);
  state.counters["iteration_share"] = median(iteration_share);
}
BENCHMARK(channel_cycle)->UseManualTime()->Iterations(rounds);

// -------------------------------------------------------------------------------------------- round trips

constexpr std::uint64_t trips = 20'000;

/// The processors of the two threads of a round trip. Left to the scheduler, the same program takes 2 us or
/// 50.
struct Placement {
  int one, other;
};
constexpr Placement one_core{0, 0}, two_cores{0, 1};

/// Wall time of an iteration of subsystem 0.
[[nodiscard]] double trip_ns(void (*build)(Robot&, Placement), Placement placement) {
  std::int64_t begin = 0, end = 0;
  Robot robot([&](std::uint32_t number, Context& context) {
    if (number != 0) return;
    if (context.iteration == 1000) begin = wall_ns();
    if (context.iteration != 1000 + trips) return;
    end = wall_ns();
    context.stop("enough");
  });
  build(robot, placement);
  robot.run();
  return static_cast<double>(end - begin) / static_cast<double>(trips);
}

/// A value there, its acknowledgement back.
void one_channel(Robot& robot, Placement placement) {
  const std::uint32_t from = robot.add(nets::patient_sender, Duration{0}, placement.one),
                      to = robot.add(nets::patient_receiver, Duration{0}, placement.other);
  robot.connect(from, "x", to, "x", acknowledged);
}

/// A value there and acknowledged, another back and acknowledged.
void both_ways(Robot& robot, Placement placement) {
  const std::uint32_t asker = robot.add(nets::asker, Duration{0}, placement.one),
                      answerer = robot.add(nets::answerer, Duration{0}, placement.other);
  robot.connect(asker, "out", answerer, "in", acknowledged);
  robot.connect(answerer, "out", asker, "in", acknowledged);
}

void futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value) {
  syscall(SYS_futex, &word, operation, value, nullptr, nullptr, 0);
}

void stay_on(int cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu, &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0) std::abort();
}

/// Two threads that only wake each other.
[[nodiscard]] double bare_round_trip_ns(Placement placement) {
  struct alignas(64) Word {
    std::atomic<std::uint32_t> value{0};
  };
  std::array<Word, 2> words;
  const auto tell = [](Word& word, std::uint32_t value) {
    word.value.store(value);
    futex(word.value, FUTEX_WAKE_PRIVATE, 1);
  };
  const auto await = [](Word& word, std::uint32_t value) {
    for (std::uint32_t seen = word.value.load(); seen != value; seen = word.value.load())
      futex(word.value, FUTEX_WAIT_PRIVATE, seen);
  };
  std::int64_t took = 0;
  std::thread other([&] {
    stay_on(placement.other);
    for (std::uint32_t trip = 1; trip <= trips; ++trip) {
      await(words[0], trip);
      tell(words[1], trip);
    }
  });
  std::thread one([&] {
    stay_on(placement.one);
    const std::int64_t begin = wall_ns();
    for (std::uint32_t trip = 1; trip <= trips; ++trip) {
      tell(words[0], trip);
      await(words[1], trip);
    }
    took = wall_ns() - begin;
  });
  one.join();
  other.join();
  return static_cast<double>(took) / static_cast<double>(trips);
}

void blocking_round_trip(benchmark::State& state, void (*build)(Robot&, Placement), Placement placement) {
  std::vector<double> ns, bare_ns, ratio;
  for (auto _ : state) {
    bare_ns.push_back(bare_round_trip_ns(placement));
    ns.push_back(trip_ns(build, placement));
    ratio.push_back(ns.back() / bare_ns.back());
    state.SetIterationTime(ns.back() * 1e-9);
  }
  state.counters["trip_ns"] = median(ns);
  state.counters["bare_ns"] = median(bare_ns);
  state.counters["ratio"] = median(ratio);
}
BENCHMARK_CAPTURE(blocking_round_trip, one_channel_one_core, one_channel, one_core)
    ->UseManualTime()
    ->Iterations(rounds);
BENCHMARK_CAPTURE(blocking_round_trip, one_channel_two_cores, one_channel, two_cores)
    ->UseManualTime()
    ->Iterations(rounds);
BENCHMARK_CAPTURE(blocking_round_trip, both_ways_one_core, both_ways, one_core)
    ->UseManualTime()
    ->Iterations(rounds);
BENCHMARK_CAPTURE(blocking_round_trip, both_ways_two_cores, both_ways, two_cores)
    ->UseManualTime()
    ->Iterations(rounds);

}  // namespace
}  // namespace tessera::benchmarks

BENCHMARK_MAIN();
