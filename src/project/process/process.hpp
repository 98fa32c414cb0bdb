#pragma once

#include <sys/types.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::project {

/// A program and its arguments; no shell is involved.
using Command = std::vector<std::string>;

/// How a child process ended.
struct Exit {
  int code = 0;      ///< its exit code, or 128 + signal
  std::string text;  ///< its output, if it was captured
  int signal = 0;    ///< of `capture`: the last one that asked this process to stop meanwhile; 0: none
};

/// Thrown in place of a result: a signal has asked this process to stop while a program ran for it.
struct Interrupted : std::runtime_error {
  Interrupted(int by, const std::string& what) : std::runtime_error(what), signal(by) {}
  int signal;
};

/// Runs a program to its end with this process's terminal. The signals that would end or stop this
/// process (tessera/signals.hpp) are passed on to the program, which decides what to do about them.
/// While it is stopped, so is this process. After a signal to stop, text for a standard stream that takes none
/// for a second is dropped.
///
/// Throws std::runtime_error if it cannot be started.
[[nodiscard]] Exit run(const Command& command);

/// Runs a program and captures its output on both streams; each_line receives every line as it
/// comes. Signals as with run, but they go to all processes that it starts. It has no input.
[[nodiscard]] Exit capture(const Command& command,
                           const std::function<void(std::string_view)>& each_line = {});

/// The same in a process group of its own, which Ctrl-C does not reach. When `stop` becomes true
/// (it is checked ten times a second), the program gets SIGINT, and SIGKILL five seconds later.
/// started: receives the process id.
/// Threads: any number at a time. Only the last 64 kB of the output are kept.
[[nodiscard]] Exit capture_apart(const Command& command, const std::atomic<bool>& stop,
                                 const std::function<void(std::string_view)>& each_line = {},
                                 const std::function<void(pid_t)>& started = {});

/// The command as a user would type it.
[[nodiscard]] std::string shell_line(const Command& command);

}  // namespace tessera::project
