#include "drivers/driver_watch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <utility>

#include "system/stop_signals.hpp"
#include "system/waker.hpp"

namespace tessera {
namespace {

constexpr std::int64_t first_report_ns = 1'000'000'000;
constexpr auto between_looks_at_drivers = std::chrono::milliseconds(50);

std::atomic<DriverWatch*> watch_in_force{nullptr};
// the process that owns the watch, as opposed to a process that user code has forked
std::atomic<pid_t> watched_process{0};

[[noreturn]] void wait_for_the_end() {
  for (;;) pause();
}

[[nodiscard]] double lasts_s(std::int64_t since_ns) {
  return static_cast<double>(monotonic_ns() - since_ns) * 1e-9;
}

}  // namespace

constinit thread_local DriverWatch* DriverWatch::of_thread_ = nullptr;

DriverWatch::DriverWatch(Duration patience, Warn warn, EndProcess end_process)
    : patience_(patience),
      warn_(std::move(warn)),
      end_process_(std::move(end_process)),
      thread_([this] { watch(); }) {
  // It cannot be undone, so it is done once; without a watch the handler does nothing.
  static const bool noticed = on_exit(on_exit_called, nullptr) == 0;
  static_cast<void>(noticed);
  watched_process = getpid();
  watch_in_force = this;
  of_thread_ = this;
}

DriverWatch::~DriverWatch() {
  of_thread_ = nullptr;
  watch_in_force = nullptr;
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  news_.notify_one();
  thread_.join();
}

DriverWatch::Call::Call(Step step, std::string_view path) : watch_(of_thread_) {
  if (watch_ == nullptr) return;
  const std::lock_guard lock(watch_->mutex_);
  watch_->call_ = Noted{.step = step, .path = path, .since_ns = monotonic_ns()};
  watch_->news_.notify_one();
}

DriverWatch::Call::~Call() {
  if (watch_ == nullptr) return;
  std::unique_lock lock(watch_->mutex_);
  watch_->call_.reset();
  if (!watch_->has_given_up_) return;
  lock.unlock();
  wait_for_the_end();
}

void DriverWatch::watch() {
  std::unique_lock lock(mutex_);
  while (!is_over_) {
    if (!call_) {
      news_.wait(lock, [this] { return is_over_ || call_; });
      continue;
    }
    news_.wait_for(lock, between_looks_at_drivers, [this] { return is_over_; });
    if (is_over_ || !call_) continue;
    if (is_too_long(*call_))
      give_up(lock,
              fmt::format("{} has not returned for {:.1f} s", name_of(*call_), lasts_s(call_->since_ns)));
    report(*call_);
  }
}

bool DriverWatch::is_too_long(Noted& call) const {
  const std::int64_t now_ns = monotonic_ns();
  if (!at_start(call)) return now_ns - call.since_ns >= patience_.count();
  const int signal = StopSignals::pending();
  if (signal == 0) return false;
  if (!call.asked_ns) {
    call.asked_ns = now_ns;
    warn_(fmt::format("{}; waits for {}, for at most {:.1f} s", StopSignals::name(signal), name_of(call),
                      static_cast<double>(patience_.count()) * 1e-9));
  }
  return now_ns - *call.asked_ns >= patience_.count();
}

void DriverWatch::report(Noted& call) const {
  const std::int64_t lasts_ns = monotonic_ns() - call.since_ns;
  if (lasts_ns < first_report_ns || lasts_ns < 2 * call.said_ns || call.asked_ns) return;
  call.said_ns = lasts_ns;
  warn_(fmt::format("waits for {} ({:.1f} s){}", name_of(call), static_cast<double>(lasts_ns) * 1e-9,
                    at_start(call) ? "; Ctrl-C ends the run" : ""));
}

std::string DriverWatch::name_of(const Noted& call) {
  const char* what = "";
  switch (call.step) {
    case Step::constructor:
      what = "the constructor of the driver";
      break;
    case Step::open:
      what = "open()";
      break;
    case Step::safe_command:
      what = "the first safe command";
      break;
    case Step::close:
      what = "close()";
      break;
    case Step::destructor:
      what = "the destructor of the driver";
      break;
  }
  return fmt::format("{} of {}", what, call.path);
}

void DriverWatch::give_up(std::unique_lock<std::mutex>& lock, const std::string& what) {
  const bool is_first = !std::exchange(has_given_up_, true);
  lock.unlock();
  if (!is_first) wait_for_the_end();
  end_process_(what);
  _exit(1);
}

/// It runs on the thread that has called exit.
void DriverWatch::on_exit_called(int code, void* /*unused*/) {
  DriverWatch* const watch = watch_in_force.load();
  if (watch == nullptr || watched_process.load() != getpid()) return;
  std::unique_lock lock(watch->mutex_);
  const std::string who =
      of_thread_ == watch && watch->call_ ? name_of(*watch->call_) : std::string("the controller");
  watch->give_up(lock, fmt::format("{} has called exit({})", who, code));
}

}  // namespace tessera
