#pragma once

#include <sys/types.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::project {

/// A program and its arguments; no shell is involved.
using Command = std::vector<std::string>;

/// How a child ended.
struct Exit {
  int code = 0;      ///< its exit code, or 128 + signal
  std::string text;  ///< what it printed, where that was captured
};

/// Runs a program to its end with this process's terminal. The signals that would end or stop this process
/// (tessera/signals.hpp) are passed on to it, and it decides what to do about them. While it is stopped, so
/// is this process.
///
/// Throws std::runtime_error when it cannot be started.
[[nodiscard]] Exit run(const Command& command);

/// Runs a program and captures what it prints on both streams; each_line sees every line as it comes. Signals
/// as with run.
[[nodiscard]] Exit capture(const Command& command,
                           const std::function<void(std::string_view)>& each_line = {});

/// The same in a process group of its own, of which Ctrl-C does not get hold: `stop`, looked at ten times a
/// second, sends it SIGINT when it becomes true, and SIGKILL five seconds later. started: told its number.
///
/// Threads: any number at a time. What it prints beyond the last 64 kB is not kept.
[[nodiscard]] Exit capture_apart(const Command& command, const std::atomic<bool>& stop,
                                 const std::function<void(std::string_view)>& each_line = {},
                                 const std::function<void(pid_t)>& started = {});

/// The command as one would type it.
[[nodiscard]] std::string shell_line(const Command& command);

}  // namespace tessera::project
