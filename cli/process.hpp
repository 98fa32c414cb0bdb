#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::cli {

/// A program and its arguments; no shell is involved.
using Command = std::vector<std::string>;

/// How a child ended.
struct Exit {
  int code = 0;      ///< its exit code, or 128 + signal
  std::string text;  ///< what it printed, where that was captured
};

/// Runs a program to its end with this process's terminal. SIGINT and SIGTERM are passed on to it, and it
/// decides what to do about them.
///
/// Throws std::runtime_error when it cannot be started.
[[nodiscard]] Exit run(const Command& command);

/// Runs a program and captures what it prints on both streams; each_line sees every line as it comes.
[[nodiscard]] Exit capture(const Command& command,
                           const std::function<void(std::string_view)>& each_line = {});

/// The command as one would type it.
[[nodiscard]] std::string shell_line(const Command& command);

}  // namespace tessera::cli
