#pragma once

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <functional>
#include <new>
#include <thread>

namespace tessera::testing {

/// The commands that a device of a child process got, seen by its parent, even after the end of the child.
struct CommandLog {
  std::atomic<std::uint64_t> commands{0}, safe{0};
  std::atomic<double> last{0};
  std::atomic<std::int64_t> last_ns{0};

  void note(double value, double safe_value) {
    last = value;
    last_ns = std::chrono::steady_clock::now().time_since_epoch().count();
    ++(value == safe_value ? safe : commands);
  }
};

/// A separate process for a run, whose exit code is the result.
class ChildRun {
 public:
  /// body: in the child; returns its exit code.
  explicit ChildRun(const std::function<int(CommandLog&)>& body)
      : log_(new (mmap(nullptr, sizeof(CommandLog), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1,
                       0)) CommandLog) {
    pid_ = fork();
    if (pid_ == 0) _exit(body(*log_));
  }
  ChildRun(const ChildRun&) = delete;
  ChildRun& operator=(const ChildRun&) = delete;
  ~ChildRun() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    munmap(log_, sizeof(CommandLog));
  }

  [[nodiscard]] CommandLog& log() { return *log_; }
  void kill(int signal) const { ::kill(pid_, signal); }
  /// Until it holds; false: not within a minute.
  template <class Condition>
  [[nodiscard]] bool await(Condition condition) const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > until) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  [[nodiscard]] bool await_commands(std::uint64_t more) {
    const std::uint64_t wanted = log_->commands + more;
    return await([&] { return log_->commands >= wanted; });
  }
  /// Its exit code; 1000 + signal when one has killed it, 2000 + signal when one has stopped it.
  [[nodiscard]] int wait() {
    int status = 0;
    waitpid(pid_, &status, WUNTRACED);
    if (WIFSTOPPED(status)) return 2000 + WSTOPSIG(status);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }

 private:
  CommandLog* log_;
  pid_t pid_ = -1;
};

}  // namespace tessera::testing
