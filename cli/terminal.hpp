#pragma once

#include <string>
#include <string_view>

#include "project/process/listener.hpp"

namespace tessera::cli {

/// The command's exit codes.
inline constexpr int ok = 0, failed = 1, usage = 2, unknown = 3, interrupted = 130;

/// Of a command that got no net to work with: `usage` if a file could not be read (missing, no YAML, no
/// PNML), else `failed`: the file was read, and what it says is wrong or violated.
[[nodiscard]] int exit_code_without_net();
/// Do the diagnostics say that the file could not be read?
[[nodiscard]] bool is_unreadable(const diagnostics::Diagnostics& found);

/// Standard error is a terminal that takes colours (NO_COLOR is honoured).
[[nodiscard]] bool colour();

/// "tessera: error: TEXT" to standard error; returns `failed`, so that a command can end with it.
int complain(const std::string& text);

/// Writes a file, or standard output for "-". Throws std::runtime_error with path and reason, also when
/// something else than earlier output of that kind is there (check_replaceable).
void write_output(const std::string& file, std::string_view text);

/// Standard error. What goes on is one line that is written again and again, and nothing when standard error
/// is no terminal.
[[nodiscard]] project::Listener& terminal();

}  // namespace tessera::cli
