#include "waker.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

namespace tessera {

std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void WakeWord::wake() {
  wakes_.fetch_add(1, std::memory_order_seq_cst);
  if (!sleeping_.load(std::memory_order_seq_cst)) return;
  syscall(SYS_futex, &wakes_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

void WakeWord::sleep(std::uint32_t ticket, std::int64_t until_ns) {
  // Sequentially consistent: either this thread sees the new count, or the one that wakes sees that it
  // sleeps.
  sleeping_.store(true, std::memory_order_seq_cst);
  if (wakes_.load(std::memory_order_seq_cst) == ticket) {
    timespec until{};
    until.tv_sec = until_ns / 1'000'000'000;
    until.tv_nsec = until_ns % 1'000'000'000;
    // BITSET takes an absolute time of CLOCK_MONOTONIC. Whatever ends the wait, the caller looks at its net
    // again.
    syscall(SYS_futex, &wakes_, FUTEX_WAIT_BITSET_PRIVATE, ticket, until_ns < 0 ? nullptr : &until, nullptr,
            FUTEX_BITSET_MATCH_ANY);
  }
  sleeping_.store(false, std::memory_order_relaxed);
}

}  // namespace tessera
