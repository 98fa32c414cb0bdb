#include "system/stop_signals.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>

#include "system/waker.hpp"

namespace tessera {
namespace {

std::atomic<int> caught{0};
std::atomic<std::int64_t> caught_at_ns{0};  // 0: none
std::atomic<bool> suspension{false};
// Never closed: a handler in another thread may be about to write when the object that installed it ends, and its
// number may belong to a device by then.
std::atomic<int> wake_descriptor{-1};
std::atomic<pid_t> opened_by{0};  // a child of the process must not wake its parent
std::atomic<int> depth{0};
constexpr std::int64_t second_signal_after_ns = 1'000'000'000;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free &&
              std::atomic<std::int64_t>::is_always_lock_free);  // because signal handlers use them

void wake_up() {
  const std::uint64_t one = 1;
  if (const int descriptor = wake_descriptor.load(); descriptor >= 0) [[maybe_unused]]
    const ssize_t written = write(descriptor, &one, sizeof one);
}

void open_wake_descriptor() {
  if (wake_descriptor < 0 || opened_by != getpid()) {
    wake_descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    opened_by = getpid();
  }
  StopSignals::take_news();
}

/// Whether a person or a parent sends it deliberately. No timer and no terminal sends these repeatedly.
[[nodiscard]] bool is_deliberate(int signal) {
  return signal == SIGINT || signal == SIGTERM || signal == SIGQUIT;
}

void note_stop(int signal) {
  const int kept_errno = errno;
  const std::int64_t now_ns = monotonic_ns();  // clock_gettime is allowed in a handler
  // The time first: a thread that handles the second signal meanwhile must not take the first for an old one.
  std::int64_t none = 0;
  if (caught_at_ns.compare_exchange_strong(none, now_ns)) {
    caught = signal;
  } else if (is_deliberate(signal) && now_ns - caught_at_ns > second_signal_after_ns) {
    std::signal(signal, SIG_DFL);
    raise(signal);
  }
  wake_up();
  errno = kept_errno;
}

void note_suspension(int /*signal*/) {
  const int kept_errno = errno;
  suspension = true;
  wake_up();
  errno = kept_errno;
}

[[nodiscard]] bool is_left_to_others(int signal, const struct sigaction& before) {
  if (signal == SIGINT || signal == SIGTERM) return false;
  return (before.sa_flags & SA_SIGINFO) != 0 || before.sa_handler != SIG_DFL;
}

}  // namespace

StopSignals::StopSignals(Suspension wanted) {
  if (depth++ > 0) return;
  outermost_ = true;
  caught = 0;
  caught_at_ns = 0;
  suspension = false;
  open_wake_descriptor();
  for_handled_signals([&](int signal, SignalUse use) {
    if (use == SignalUse::suspend && wanted == Suspension::usual) return;
    Before before{signal, {}};
    if (sigaction(signal, nullptr, &before.action) != 0 || is_left_to_others(signal, before.action)) return;
    struct sigaction action {};
    const bool stops =
        use == SignalUse::stop || (use == SignalUse::suspend && wanted == Suspension::ends_run);
    action.sa_handler = stops ? note_stop : use == SignalUse::suspend ? note_suspension : SIG_IGN;
    action.sa_flags = SA_RESTART;  // reads of a driver must not fail because a terminal closes
    sigemptyset(&action.sa_mask);
    if (sigaction(signal, &action, nullptr) == 0) before_.push_back(before);
  });
}

StopSignals::~StopSignals() {
  --depth;
  if (!outermost_) return;
  for (const Before& before : before_) sigaction(before.signal, &before.action, nullptr);
}

int StopSignals::pending() { return caught.load(); }

bool StopSignals::suspension_asked() { return suspension.load(); }

void StopSignals::resume() { suspension = false; }

int StopSignals::descriptor() { return wake_descriptor.load(); }

void StopSignals::take_news() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t taken = read(descriptor(), &count, sizeof count);
}

}  // namespace tessera
