#pragma once

#include <sys/types.h>

#include <atomic>
#include <functional>
#include <thread>

#include "tessera/time.hpp"

namespace tessera {

/// Another process whose end is noticed at once, however it ends.
///
/// Threads: one at a time.
class OtherProcess {
 public:
  /// A process that does not exist counts as ended.
  explicit OtherProcess(pid_t process);
  OtherProcess(const OtherProcess&) = delete;
  OtherProcess& operator=(const OtherProcess&) = delete;
  ~OtherProcess();

  /// Waits until the process has ended, `descriptor` is readable, or the limit is over (negative: no
  /// limit). descriptor: -1: none. Returns whether the process has ended.
  [[nodiscard]] bool await_end(int descriptor, int limit_ms) const;

 private:
  pid_t process_;
  int handle_;  // pidfd; -1: the process is gone, or the kernel has no pidfds
};

/// A thread that waits for the end of another process.
///
/// Threads: constructed and destroyed by one; the callbacks run on the thread of the watch.
class ProcessWatch {
 public:
  /// Something that is done again and again while the process lives.
  struct Look {
    Duration period;
    std::function<void()> at_it;  ///< empty: nothing
  };
  /// on_end: called once if the process ends while the watch exists. Throws std::system_error: no thread.
  ProcessWatch(pid_t process, std::function<void()> on_end, Look look = {Duration::zero(), {}});
  ProcessWatch(const ProcessWatch&) = delete;
  ProcessWatch& operator=(const ProcessWatch&) = delete;
  ~ProcessWatch();

 private:
  void run();
  OtherProcess process_;
  std::function<void()> on_end_;
  Look look_;
  int enough_;  // eventfd
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

}  // namespace tessera
