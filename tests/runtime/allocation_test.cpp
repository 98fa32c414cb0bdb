#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "nets.hpp"
#include "test_system.hpp"

// Counts every allocation and every lock of this program, so this test is a program of its own.
namespace {
std::atomic<std::uint64_t> allocations{0}, locks{0};
void* counted(std::size_t size, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  void* memory = alignment <= alignof(std::max_align_t)
                     ? std::malloc(size)
                     : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
}  // namespace

// g++ inlines one of the two without the other, and then warns of the pair.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void* operator new(std::size_t size) { return counted(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto next = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  locks.fetch_add(1, std::memory_order_relaxed);
  return next(mutex);
}

using namespace std::chrono_literals;

namespace tessera::testing {
namespace {

struct Cost {
  std::uint64_t allocations, locks;
  bool operator==(const Cost&) const = default;
};
void PrintTo(const Cost& cost, std::ostream* out) {
  *out << cost.allocations << " allocations, " << cost.locks << " locks";
}

/// The cost of a run of that length, with a recording, log lines, timeouts, a chain and a device. Allocations are
/// counted until the last call of user code, because the check at the end for stuck subsystems allocates.
[[nodiscard]] Cost cost_of_a_run(RunOptions::Clock clock, Duration duration) {
  TestSystem system;
  Script sender, receiver;
  std::uint64_t allocations_at_last_call = 0;
  sender.call = [&](ScriptState& state) {
    allocations_at_last_call = allocations.load();
    state.out_x = 1;
    state.word = state.context.iteration % 3 == 0 ? "a" : "another";
    ++state.count;
    if (state.context.iteration % 10 == 0) state.context.log("iteration {}", state.context.iteration);
  };
  sender.remembers = true;
  std::vector<double>& commands = system.devices.commands;
  commands.reserve(100'000);
  receiver.acts = true;
  receiver.call = [](ScriptState& state) { state.command = state.x.value(); };
  const auto a = system.add("robot.a", nets::nb_sender, sender, 3ms);
  const auto b = system.add("robot.b", nets::b_receiver_timed, receiver, 1ms, 20ms, Kind::effector);
  system.connect(a, "x", b, "x", buffered, 0ms, 1ms);
  // Every command is too old.
  system.chains = {{"a to b", Duration(1), Duration(1)}};
  static constexpr std::initializer_list<std::uint32_t> channels{0};
  system.chain_ways = {{0, channels}};
  RunOptions options = simulated(duration);
  options.clock = clock;
  options.recording = scratch_file("run");
  options.monitor = clock == RunOptions::Clock::steady;  // without a client
  const Cost before{allocations.load(), locks.load()};
  EXPECT_GT(run(system, options).firings, 10u);
  // The device of the test locks whenever it is written to.
  return {allocations_at_last_call - before.allocations, locks.load() - before.locks - commands.size()};
}

/// Runs of both lengths cost the same. A cost of each firing, or of each line of the log, shows in every try. On a
/// loaded machine one of the runs may have a cost that the other has not, such as that of a subsystem that is late.
void expect_length_costs_nothing(RunOptions::Clock clock, Duration shorter, Duration longer, int tries) {
  static_cast<void>(cost_of_a_run(clock, shorter));  // allocates everything that a process allocates once
  Cost cheap{}, dear{1, 1};
  for (int made = 0; made < tries && cheap != dear; ++made) {
    cheap = cost_of_a_run(clock, shorter);
    dear = cost_of_a_run(clock, longer);
  }
  EXPECT_EQ(cheap, dear);
}

TEST(FiringPath, NeitherAllocatesNorLocksUnderTheSimulatedClock) {
  expect_length_costs_nothing(RunOptions::Clock::simulated, 10ms, 5s, 1);
}

TEST(FiringPath, NeitherAllocatesNorLocksUnderTheSteadyClock) {
  expect_length_costs_nothing(RunOptions::Clock::steady, 50ms, 200ms, 5);
}

TEST(FiringPath, TheCountersCount) {
  const Cost before{allocations.load(), locks.load()};
  std::atomic<int>* volatile made = new std::atomic<int>(1);  // not left out by the compiler
  delete made;
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&mutex);
  pthread_mutex_unlock(&mutex);
  EXPECT_GT(allocations.load(), before.allocations);
  EXPECT_GT(locks.load(), before.locks);
}

}  // namespace
}  // namespace tessera::testing
