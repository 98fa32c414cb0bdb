#include "system/waker.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>

namespace tessera {

std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void WakeWord::wake() {
  // A sleeper that looks for work later reads this exchange first, and with it the
  // changes that caused the wake-up.
  // Stored before: the sleeper reads it after the exchange. If two wake it, the second may store a later moment.
  if (state_.load(std::memory_order_relaxed) >= asleep)
    woken_ns_.store(monotonic_ns(), std::memory_order_relaxed);
  if (state_.exchange(woken, std::memory_order_acq_rel) < asleep) return;
  syscall(SYS_futex, &state_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

namespace {

/// Waits while the word is `expected`, until CLOCK_MONOTONIC shows until_ns
/// (negative: no limit) or a wake-up.
void wait_while(std::atomic<std::uint32_t>& word, std::uint32_t expected, std::int64_t until_ns) {
  timespec until{};
  until.tv_sec = until_ns / 1'000'000'000;
  until.tv_nsec = until_ns % 1'000'000'000;
  // BITSET takes an absolute time of CLOCK_MONOTONIC.
  syscall(SYS_futex, &word, FUTEX_WAIT_BITSET_PRIVATE, expected, until_ns < 0 ? nullptr : &until, nullptr,
          FUTEX_BITSET_MATCH_ANY);
}

}  // namespace

std::int64_t WakeWord::sleep(std::uint32_t ticket, std::int64_t until_ns) {
  const std::uint32_t how = until_ns < 0 ? at_rest : asleep;
  if (how == at_rest) rests_.store(rests_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  if (!state_.compare_exchange_strong(ticket, how, std::memory_order_acq_rel)) return -1;  // woken meanwhile
  wait_while(state_, how, until_ns);  // whatever ends the wait, the caller checks its net again
  const bool is_woken = state_.load(std::memory_order_acquire) == woken;
  const std::int64_t woken_ns = is_woken ? woken_ns_.load(std::memory_order_relaxed) : -1;
  if (until_ns < 0 || until_ns > monotonic_ns()) return woken_ns;
  return is_woken ? std::min(woken_ns, until_ns) : until_ns;
}

bool WakeWord::rest_until(std::uint32_t ticket, std::int64_t until_ns, bool again) {
  if (!again) {
    rests_.store(rests_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (!state_.compare_exchange_strong(ticket, at_rest, std::memory_order_acq_rel)) return true;
  }
  wait_while(state_, at_rest, until_ns);
  return state_.load(std::memory_order_acquire) != at_rest;
}

std::uint64_t WakeWord::rest() const {
  if (state_.load(std::memory_order_acquire) != at_rest) return 0;
  return rests_.load(std::memory_order_relaxed);
}

}  // namespace tessera
