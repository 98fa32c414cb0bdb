#include "safety/rescue.hpp"

#include <algorithm>
#include <csetjmp>
#include <csignal>
#include <ctime>
#include <system_error>

#include "system/realtime.hpp"
#include "system/thread_role.hpp"

namespace tessera {
namespace {

constexpr std::int64_t between_rescue_attempts_ns = 2'000'000;

/// The point at which a thread of a Rescuer continues when a driver crashes.
struct WayOut {
  sigjmp_buf place;
  volatile bool open = false;
};
thread_local constinit WayOut* way_out = nullptr;

/// Leaves signals that are sent to the process to other threads.
void block_all_signals() {
  sigset_t all;
  sigfillset(&all);
  for (const int deadly : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP})
    sigdelset(&all, deadly);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

}  // namespace

Rescuer::Rescuer(std::span<const std::unique_ptr<SubsystemExecutor>> executors, int priority) {
  for (const auto& executor : executors)
    for (std::size_t index = 0; index < executor->effectors().size(); ++index)
      devices_.emplace_back(executor->effectors(), index);
  try {
    for (std::size_t number = 0; number < std::min(devices_.size(), most_threads); ++number) {
      Thread& made = threads_.emplace_back();
      made.thread = std::thread([this, &made, priority] { run(made.asked, priority); });
    }
  } catch (...) {
    end_threads();
    throw;
  }
}

Rescuer::~Rescuer() { end_threads(); }

void Rescuer::end_threads() {
  state_.store(State::leaves, std::memory_order_release);
  for (Thread& one : threads_) one.asked.wake();
  for (Thread& one : threads_)
    if (one.thread.joinable()) one.thread.join();
}

bool Rescuer::rescue(const void* dead, Duration limit) {
  const std::int64_t until_ns = monotonic_ns() + limit.count();
  dead_.store(dead, std::memory_order_relaxed);
  until_ns_.store(until_ns, std::memory_order_relaxed);
  state_.store(State::is_asked, std::memory_order_release);
  for (Thread& one : threads_) one.asked.wake();
  State state = State::is_asked;
  while (monotonic_ns() < until_ns) {
    const std::uint32_t ticket = answered_.ticket();
    state = state_.load(std::memory_order_acquire);
    if (state != State::is_asked) break;
    answered_.sleep(ticket, until_ns);
  }
  return state == State::has_succeeded;
}

void Rescuer::leave_crashed_driver() {
  if (way_out == nullptr || !way_out->open) return;
  way_out->open = false;
  siglongjmp(way_out->place, 1);
}

void Rescuer::run(WakeWord& asked, int priority) {
  block_all_signals();
  const RealTimePriority realtime(priority);
  const AlternateStack stack;
  WayOut own;
  way_out = &own;
  for (;;) {
    const std::uint32_t ticket = asked.ticket();
    const State state = state_.load(std::memory_order_acquire);
    if (state == State::leaves) return;
    if (state == State::is_asked) make_all_safe();
    asked.sleep(ticket, -1);
  }
}

/// Tries devices that are in use again and again. They do not delay the others.
void Rescuer::make_all_safe() {
  static_cast<void>(try_all(/*dead_too=*/false));
  bool all = try_all(/*dead_too=*/true);
  while (!all && monotonic_ns() < until_ns_.load(std::memory_order_relaxed)) {
    const timespec pause{.tv_sec = 0, .tv_nsec = between_rescue_attempts_ns};
    nanosleep(&pause, nullptr);
    all = try_all(/*dead_too=*/true);
  }
  State asked = State::is_asked;
  if (state_.compare_exchange_strong(asked, all ? State::has_succeeded : State::has_tried)) answered_.wake();
}

bool Rescuer::try_all(bool dead_too) {
  const void* const dead = dead_.load(std::memory_order_relaxed);
  bool all = true;
  for (RescuedDevice& device : devices_) {
    const bool is_dead = dead != nullptr && device.effectors->device(device.index) == dead;
    if (!device.safe && !device.crashed && (dead_too || !is_dead) && !device.tried.exchange(true)) {
      if (!device.safe) try_one(device);
      device.tried = false;
    }
    all = all && device.safe;
  }
  return all;
}

/// A driver that crashes has refused. The data of its stack frames is not released, since the process ends.
void Rescuer::try_one(RescuedDevice& device) {
  device.crashed = true;  // reset when the driver returns
  if (sigsetjmp(way_out->place, /*save the signal mask*/ 1) != 0) return;
  way_out->open = true;
  device.safe = device.effectors->rescue(device.index, dead_.load(std::memory_order_relaxed));
  way_out->open = false;
  device.crashed = false;
}

}  // namespace tessera
