#pragma once

#include <string>
#include <string_view>

#include "project/process/listener.hpp"

namespace tessera::cli {

/// Exit codes of the commands.
inline constexpr int ok = 0, failed = 1, usage = 2, unknown = 3, interrupted = 130;

/// The exit code of a command that got no net to work with: `usage` if a file could not be read (missing, no
/// YAML, no PNML), else `failed`: the file was read, and its content is wrong or violated.
[[nodiscard]] int exit_code_without_net();
/// Whether the diagnostics say that the file could not be read.
[[nodiscard]] bool is_unreadable(const diagnostics::Diagnostics& found);

/// Whether standard error is a terminal with colours (respects NO_COLOR).
[[nodiscard]] bool colour();

/// Prints "tessera: error: TEXT" to standard error; returns `failed`, so that a command can return the
/// result.
int complain(const std::string& text);

/// Writes a file, or standard output for "-". Throws std::runtime_error with path and reason, also if the
/// file exists and is no earlier output of the same kind (check_replaceable).
void write_output(const std::string& file, std::string_view text);

/// Ends the output of a command: if standard output did not take all of it (full disk), says so. Returns the exit
/// code: `failed` in place of `ok` then.
[[nodiscard]] int end_output(int exit_code);

/// A text of a recording, a net or a controller as it goes to standard output: a terminal gets it without
/// characters that command it (tessera::printable), a file or a pipe gets its bytes.
[[nodiscard]] std::string for_output(std::string_view text);

/// A listener on standard error. Progress is one line that is rewritten; it is not shown if standard error is
/// no terminal.
[[nodiscard]] project::Listener& terminal();

}  // namespace tessera::cli
