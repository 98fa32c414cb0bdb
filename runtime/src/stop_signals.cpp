#include "stop_signals.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>

#include "waker.hpp"

namespace tessera {
namespace {

std::atomic<int> caught{0};
std::atomic<std::int64_t> caught_at_ns{0};
std::atomic<int> wake_descriptor{-1};
constexpr std::int64_t patience_ns = 1'000'000'000;
static_assert(std::atomic<int>::is_always_lock_free &&
              std::atomic<std::int64_t>::is_always_lock_free);  // what a signal handler may use

void handle(int signal) {
  const int kept_errno = errno;
  const std::int64_t now_ns = monotonic_ns();  // clock_gettime may be used in a handler
  int none = 0;
  if (caught.compare_exchange_strong(none, signal)) {
    caught_at_ns = now_ns;
  } else if (now_ns - caught_at_ns > patience_ns) {
    std::signal(signal, SIG_DFL);
    raise(signal);
  }
  const std::uint64_t one = 1;
  if (const int descriptor = wake_descriptor.load(); descriptor >= 0) [[maybe_unused]]
    const ssize_t written = write(descriptor, &one, sizeof one);
  errno = kept_errno;
}

}  // namespace

StopSignals::StopSignals() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  caught = 0;
  wake_descriptor = descriptor_;
  struct sigaction action {};
  action.sa_handler = handle;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &before_interrupt_);
  sigaction(SIGTERM, &action, &before_terminate_);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &before_interrupt_, nullptr);
  sigaction(SIGTERM, &before_terminate_, nullptr);
  wake_descriptor = -1;
  if (descriptor_ >= 0) close(descriptor_);
}

int StopSignals::pending() { return caught.load(); }

const char* StopSignals::name(int signal) { return signal == SIGINT ? "SIGINT" : "SIGTERM"; }

}  // namespace tessera
