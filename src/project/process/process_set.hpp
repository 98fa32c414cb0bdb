#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "project/process/process.hpp"

namespace tessera::project {

/// The result of one start of a process.
struct ProcessEnd {
  std::size_t process = 0;
  unsigned start = 1;  ///< 1 for the first
  Exit exit;           ///< code: as in Exit; no text
  std::chrono::nanoseconds ran{};
  bool asked = false;  ///< it had been asked to stop before
};

/// The reaction to a process that ends by itself with a failure.
struct FailurePolicy {
  bool restarts = false;  ///< it is started again, after a pause that doubles
  bool stops_all = true;  ///< it is not started again: the others are stopped too
  /// Restarts in a row, none of which lasted for `settled`, after which it is not started again.
  unsigned most_restarts = 5;
  std::chrono::milliseconds first_pause{1000}, longest_pause{30'000};
  std::chrono::milliseconds settled{60'000};
};

/// Receives what happens, in the thread that calls run().
class ProcessSetListener {
 public:
  virtual ~ProcessSetListener() = default;
  virtual void started(std::size_t process, unsigned start, pid_t pid) = 0;
  /// A line of its output, without the end of line.
  virtual void said(std::size_t process, std::string_view line) = 0;
  /// again_in: it is started again after that time; nullopt: it is not.
  virtual void ended(const ProcessEnd& end, std::optional<std::chrono::milliseconds> again_in) = 0;
  /// A process is due to be started again: it is, or this is asked again soon, or it stays down for good.
  enum class Again : std::uint8_t { now, later, never };
  virtual Again may_start_again(std::size_t /*process*/) { return Again::now; }
  /// All are asked to stop. signal: the received one; 0: because one process has failed.
  virtual void stopping(int signal) = 0;
  /// Processes that have been asked to stop a while ago and still run.
  virtual void waits_for(const std::vector<std::size_t>& processes) = 0;
};

/// Runs several processes to their ends.
///
/// Each has a process group of its own, so Ctrl-C reaches only this process, which asks all of them to stop.
/// A signal that would stop this process (tessera/signals.hpp) goes to all of them. SIGTSTP stops them, then
/// this process; after SIGCONT they go on together. A process that does not stop is asked again after ten
/// seconds, which kills a controller, and gets SIGKILL two seconds later. Nothing waits for a process that
/// writes much or nothing.
///
/// Threads: one at a time in a program, since it takes over the signals of the process during run().
class ProcessSet {
 public:
  /// The command of a start, from 1 on.
  using CommandOf = std::function<Command(std::size_t process, unsigned start)>;
  ProcessSet(std::size_t count, CommandOf command, FailurePolicy policy, ProcessSetListener& listener);
  ~ProcessSet();
  ProcessSet(const ProcessSet&) = delete;
  ProcessSet& operator=(const ProcessSet&) = delete;

  /// Starts all in their order, and returns when all have ended. Returns the signal that stopped them, or 0.
  /// Throws std::runtime_error if one cannot be started; then the others have been stopped.
  int run();
  /// The last end of each process. Only after run().
  [[nodiscard]] const std::vector<ProcessEnd>& ends() const { return ends_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Child {
    pid_t pid = 0;    ///< 0: does not run
    int output = -1;  ///< the reading end
    std::string line;
    unsigned start = 0, in_a_row = 0;
    Clock::time_point began;
    std::optional<Clock::time_point> again;  ///< when it is started again
    bool suspended = false, asked = false;
  };

  void start(std::size_t process);
  void stop_in_spite_of_exceptions();
  void start_what_is_due();
  void start_again(std::size_t process);
  void wait_for_something();
  void read_output(Child& child, std::size_t process);
  void flush_output(Child& child, std::size_t process);
  void take_signals();
  void obey(int signal);
  void collect();
  void note_end(std::size_t process, int status);
  [[nodiscard]] std::optional<std::chrono::milliseconds> pause_before(const Child& child,
                                                                      const ProcessEnd& end) const;
  void stop_all(int signal, int sent);
  void press_on();
  void suspend_together();
  void send_all(int signal) const;
  [[nodiscard]] bool any_left() const;
  [[nodiscard]] int longest_wait_ms() const;
  void take_over_signals();

  CommandOf command_;
  FailurePolicy policy_;
  ProcessSetListener& listener_;
  std::vector<Child> children_;
  std::vector<ProcessEnd> ends_;
  int signals_ = -1, stopped_by_ = 0;
  sigset_t before_{};
  bool stopping_ = false, suspending_ = false;
  Clock::time_point asked_at_{};
  unsigned pressed_ = 0;  ///< how often those that do not stop were pressed
};

}  // namespace tessera::project
