#include "system/process_watch.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <utility>

#include "system/waker.hpp"

namespace tessera {
namespace {

constexpr int poll_every_ms = 10;  // for kernels without pidfds

}  // namespace

OtherProcess::OtherProcess(pid_t process)
    : process_(process), handle_(static_cast<int>(syscall(SYS_pidfd_open, process, 0))) {}

OtherProcess::~OtherProcess() {
  if (handle_ >= 0) close(handle_);
}

bool OtherProcess::await_end(int descriptor, int limit_ms) const {
  const std::int64_t until_ns = monotonic_ns() + std::int64_t{limit_ms} * 1'000'000;
  for (;;) {
    if (handle_ < 0 && (process_ <= 0 || (kill(process_, 0) != 0 && errno == ESRCH))) return true;
    const std::int64_t left_ms = (until_ns - monotonic_ns() + 999'999) / 1'000'000;
    int wait_ms = limit_ms < 0 ? -1 : static_cast<int>(std::max<std::int64_t>(left_ms, 0));
    if (handle_ < 0) wait_ms = wait_ms < 0 ? poll_every_ms : std::min(wait_ms, poll_every_ms);
    std::array<pollfd, 2> sources{pollfd{.fd = handle_, .events = POLLIN, .revents = 0},
                                  pollfd{.fd = descriptor, .events = POLLIN, .revents = 0}};
    const int ready = poll(sources.data(), sources.size(), wait_ms);
    if (ready > 0) return sources[0].revents != 0;
    if (limit_ms >= 0 && monotonic_ns() >= until_ns) return false;
  }
}

ProcessWatch::ProcessWatch(pid_t process, std::function<void()> on_end, Look look)
    : process_(process),
      on_end_(std::move(on_end)),
      look_(std::move(look)),
      enough_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  // The run's thread handles signals.
  sigset_t all, mask;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &mask);
  try {
    thread_ = std::thread([this] { run(); });
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &mask, nullptr);
    close(enough_);
    throw;
  }
  pthread_sigmask(SIG_SETMASK, &mask, nullptr);
}

ProcessWatch::~ProcessWatch() {
  is_over_ = true;
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(enough_, &one, sizeof one);
  thread_.join();
  close(enough_);
}

void ProcessWatch::run() {
  const int limit_ms = look_.at_it ? static_cast<int>(look_.period / std::chrono::milliseconds(1)) : -1;
  while (!is_over_) {
    if (process_.await_end(enough_, limit_ms)) return on_end_();
    if (!is_over_ && look_.at_it) look_.at_it();
  }
}

}  // namespace tessera
