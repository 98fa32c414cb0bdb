#include "realtime.hpp"

#include <fmt/core.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace tessera {
namespace {

constexpr std::size_t prefaulted_bytes = std::size_t{256} << 10U, page_bytes = 4096;

[[nodiscard]] bool wants(const RealTime& realtime) {
  return realtime.policy != RealTime::Policy::usual || realtime.cpu >= 0;
}

/// Touches the calling thread's stack ahead of its use.
void prefault_stack() {
  std::array<char, prefaulted_bytes> stack;
  for (std::size_t at = 0; at < prefaulted_bytes; at += page_bytes)
    static_cast<volatile char&>(stack[at]) = 0;
}

}  // namespace

bool wants_realtime(std::span<const Instance> instances) {
  return std::any_of(instances.begin(), instances.end(),
                     [](const Instance& instance) { return wants(instance.policies.realtime); });
}

std::string schedule_this_thread(const RealTime& wanted) {
  std::string denied;
  const auto note = [&](int problem, const std::string& what) {
    if (problem == 0) return;
    denied += fmt::format("{}{}: {}", denied.empty() ? "" : "; ", what, std::strerror(problem));
  };
  if (wanted.cpu >= 0) {
    cpu_set_t processors;
    CPU_ZERO(&processors);
    CPU_SET(static_cast<std::size_t>(wanted.cpu), &processors);
    note(pthread_setaffinity_np(pthread_self(), sizeof processors, &processors),
         fmt::format("cpu {}", wanted.cpu));
  }
  if (wanted.policy != RealTime::Policy::usual) {
    const bool fifo = wanted.policy == RealTime::Policy::fifo;
    sched_param parameters{};
    parameters.sched_priority = wanted.priority;
    note(pthread_setschedparam(pthread_self(), fifo ? SCHED_FIFO : SCHED_RR, &parameters),
         fmt::format("{} priority {}", fifo ? "fifo" : "round_robin", wanted.priority));
  }
  if (wants(wanted)) prefault_stack();
  return denied;
}

std::string lock_memory() {
  // What is there now is brought in; what comes is kept once it was touched, or the stacks of all threads
  // would be.
  if (mlockall(MCL_CURRENT) == 0 && mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0) return "";
  return fmt::format("locked memory: {}", std::strerror(errno));
}

}  // namespace tessera
