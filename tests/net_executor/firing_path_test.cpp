#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tessera/net_executor.hpp"

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

namespace tessera::testing {
namespace {

/// A ring with an operation and a condition, beside a choice by priority with weights and a self-loop.
[[nodiscard]] ExecutableNet everything(int& operations) {
  return {.places = {{.tokens = 1},
                     {.operation = [&operations] { ++operations; }},
                     {},
                     {.tokens = 4},
                     {},
                     {.tokens = 1}},
          .transitions = {
              {.inputs = {{0}}, .outputs = {{1}}},
              {.inputs = {{1}}, .outputs = {{2}}, .condition = [&operations] { return operations > 0; }},
              {.inputs = {{2}}, .outputs = {{0}}},
              {.inputs = {{3, 2}}, .outputs = {{4}}, .priority = 1},
              {.inputs = {{4}, {5}}, .outputs = {{3, 2}, {5}}},
              {.inputs = {{4}}, .outputs = {{3, 2}}}}};
}

void expect_no_cost(NetExecutor::Ties ties) {
  int operations = 0;
  std::uint64_t observed = 0;
  std::string error;
  const auto executor = NetExecutor::load(
      everything(operations), {.ties = ties, .on_firing = [&](std::uint32_t) { ++observed; }}, error);
  ASSERT_NE(executor, nullptr) << error;
  const std::uint64_t allocated = allocations.load(), locked = locks.load();
  const std::uint64_t firings = executor->run(100'000).firings;
  EXPECT_EQ(allocations.load(), allocated);
  EXPECT_EQ(locks.load(), locked);
  EXPECT_EQ(firings, 100'000U);
  EXPECT_EQ(observed, firings);
  EXPECT_GT(operations, 1000);
}

TEST(FiringPath, NeitherAllocatesNorLocksWhenTiesAreFair) { expect_no_cost(NetExecutor::Ties::fair); }
TEST(FiringPath, NeitherAllocatesNorLocksWhenTiesAreByLot) { expect_no_cost(NetExecutor::Ties::random); }

TEST(FiringPath, TheCountersCount) {
  const std::uint64_t allocated = allocations.load(), locked = locks.load();
  std::atomic<int>* volatile made = new std::atomic<int>(1);  // not left out by the compiler
  delete made;
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_mutex_lock(&mutex);
  pthread_mutex_unlock(&mutex);
  EXPECT_GT(allocations.load(), allocated);
  EXPECT_GT(locks.load(), locked);
}

}  // namespace
}  // namespace tessera::testing
