#include "system/processor_clocks.hpp"

#include <pthread.h>

namespace tessera {

void ProcessorClocks::enter(std::size_t thread) {
  clockid_t own{};
  if (pthread_getcpuclockid(pthread_self(), &own) == 0) clocks_[thread].store(own, std::memory_order_relaxed);
}

Duration ProcessorClocks::used_by_others(std::size_t thread) const {
  Duration all{};
  for (std::size_t other = 0; other < threads_; ++other) {
    const clockid_t clock = clocks_[other].load(std::memory_order_relaxed);
    timespec used{};
    if (other == thread || clock == none || clock_gettime(clock, &used) != 0) continue;
    all += Duration(Duration::rep{used.tv_sec} * 1'000'000'000 + used.tv_nsec);
  }
  return all;
}

}  // namespace tessera
