#pragma once

#include <string>
#include <string_view>

#include "project/listener.hpp"

namespace tessera::cli {

/// The command's exit codes.
inline constexpr int ok = 0, failed = 1, usage = 2, unknown = 3, interrupted = 130;

/// Standard error is a terminal that takes colours (NO_COLOR is honoured).
[[nodiscard]] bool colour();

/// "tessera: error: TEXT" to standard error; returns `failed`, so that a command can end with it.
int complain(const std::string& text);

/// Writes a file, or standard output for "-". Throws std::runtime_error with path and reason.
void write_output(const std::string& file, std::string_view text);

/// Standard error. What goes on is one line that is written again and again, and nothing when standard error
/// is no terminal.
[[nodiscard]] project::Listener& terminal();

}  // namespace tessera::cli
