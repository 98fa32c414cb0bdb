#include "system/realtime.hpp"

#include <fmt/core.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

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

std::optional<Problem> schedule_this_thread(const RealTime& wanted) {
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
  if (denied.empty()) return std::nullopt;
  return Problem{std::move(denied)};
}

int supervisor_priority(std::span<const Instance> instances) {
  int highest = 0;
  for (const Instance& instance : instances)
    if (instance.policies.realtime.policy != RealTime::Policy::usual)
      highest = std::max(highest, instance.policies.realtime.priority);
  return highest == 0 ? 0 : std::min(highest + 1, sched_get_priority_max(SCHED_FIFO));
}

RealTimePriority::RealTimePriority(int priority) {
  if (priority == 0) return;
  sched_param before{};
  policy_before_ = sched_getscheduler(0);
  sched_getparam(0, &before);
  priority_before_ = before.sched_priority;
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) == 0)
    priority_ = priority;
  else
    denied_ = Problem{fmt::format("supervisor, fifo priority {}: {}", priority, std::strerror(errno))};
}

RealTimePriority::~RealTimePriority() {
  if (priority_ == 0) return;
  sched_param parameters{};
  parameters.sched_priority = priority_before_;
  // A process that may not remove RESET_ON_FORK keeps it; only the policy matters.
  if (sched_setscheduler(0, policy_before_, &parameters) != 0)
    sched_setscheduler(0, policy_before_ | SCHED_RESET_ON_FORK, &parameters);
}

std::optional<Problem> lock_memory() {
  // Memory that exists now is loaded. Later memory stays in RAM once it has been used; otherwise the stacks
  // of all threads would be loaded as a whole.
  if (mlockall(MCL_CURRENT) == 0 && mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0)
    return std::nullopt;
  return Problem{fmt::format("locked memory: {}", std::strerror(errno))};
}

}  // namespace tessera
