#include "watch/call_watch.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>

#include "system/stop_signals.hpp"

namespace tessera {
namespace {

constexpr double patience_s = 1;
constexpr auto between_looks_at_calls = std::chrono::milliseconds(100);

/// Bypasses the console, which may be silent or wait for the thread that is watched. Does not wait for a
/// blocked terminal.
void write_to_terminal(const std::string& line) {
  pollfd terminal{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
  if (poll(&terminal, 1, 100) <= 0) return;
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
}

[[nodiscard]] double now_s() { return static_cast<double>(monotonic_ns()) * 1e-9; }

}  // namespace

CallWatch::CallWatch(Assembly& assembly) : assembly_(assembly), thread_([this] { watch(); }) {}

CallWatch::~CallWatch() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  over_.notify_one();
  thread_.join();
}

void CallWatch::watch() {
  Look last;
  std::unique_lock lock(mutex_);
  while (!over_.wait_for(lock, between_looks_at_calls, [this] { return is_over_; })) look(last);
}

void CallWatch::look(Look& last) {
  const std::uint64_t turn = turns_.load(std::memory_order_acquire);
  const double now = now_s();
  if (turn != last.turn || turn % 2 == 0) {
    last = {.turn = turn, .began_s = now};
    return;
  }
  if (StopSignals::pending() != 0) {
    if (!last.asked_s) last.asked_s = now;
    if (now - *last.asked_s >= patience_s && now - last.began_s >= patience_s) give_up(last);
  }
  const double lasts = now - last.began_s;
  if (lasts < patience_s || lasts < 2 * last.said_s) return;
  last.said_s = lasts;
  write_to_terminal(fmt::format("tessera: warning: {} has not returned for {:.1f} s; the run waits for it\n",
                                function(), lasts));
}

/// Ends the process, unless the turn has ended after all.
void CallWatch::give_up(const Look& last) {
  gives_up_.store(true, std::memory_order_seq_cst);
  if (turns_.load(std::memory_order_seq_cst) != last.turn) return gives_up_.store(false);
  const int signal = StopSignals::pending();
  for (const auto& executor : assembly_.executors)
    executor->effectors().make_safe({SafeReason::Kind::leaves}, Effectors::Busy::leaves_out);
  assembly_.control.abandon();
  // Afterwards, a line that was being logged is in the recording.
  std::this_thread::sleep_for(between_looks_at_calls);
  const std::string text = fmt::format("{}; {} has not returned for {:.1f} s", StopSignals::name(signal),
                                       function(), now_s() - last.began_s);
  if (assembly_.recorder != nullptr) {
    assembly_.recorder->system_lane()->text(Event::Kind::stop, now_.load(std::memory_order_relaxed), 1, text);
    assembly_.recorder->flush();
  }
  write_to_terminal(fmt::format("tessera: error: ended by {}\n", text));
  _exit(128 + signal);
}

void CallWatch::wait_for_decision() const {
  while (gives_up_.load(std::memory_order_seq_cst)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

std::string CallWatch::function() const {
  const SubsystemExecutor& executor = *assembly_.executors[instance_.load(std::memory_order_relaxed)];
  if (std::string driver = executor.operations().driver_being_read(); !driver.empty()) return driver;
  const std::uint16_t behaviour = executor.gauges().behaviour.load(std::memory_order_relaxed);
  return fmt::format("{}.{}", executor.path(),
                     executor.operations().parts().instance->net->behaviours[behaviour].name);
}

}  // namespace tessera
