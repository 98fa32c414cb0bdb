#include "cli/terminal.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "cli/outputs.hpp"
#include "tessera/printable.hpp"

namespace tessera::cli {

bool colour() { return isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr; }

namespace {

/// A terminal that was closed, or a full disk, must not end a command: fmt::print would throw.
void put(std::string_view text) { static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr)); }

class StandardError final : public project::Listener {
 public:
  void say(std::string_view text) override { put(text); }
  void say(const diagnostics::Diagnostics& diagnostics) override {
    unreadable = unreadable || is_unreadable(diagnostics);
    say(diagnostics::render(diagnostics, colour()));
  }
  void progress(std::string_view what) override {
    if (isatty(STDERR_FILENO) == 0) return;
    put("\r\033[K");
    put(what);
    std::fflush(stderr);
  }

  bool unreadable = false;  ///< some file that was reported
};

StandardError& standard_error() {
  static StandardError one;
  return one;
}

/// Whether it was reported that standard output does not take text.
bool& output_failed() {
  static bool failed = false;
  return failed;
}

}  // namespace

bool is_unreadable(const diagnostics::Diagnostics& found) {
  const std::vector<diagnostics::Diagnostic> all = found.sorted();
  return std::ranges::any_of(all, [](const diagnostics::Diagnostic& one) {
    return one.severity == diagnostics::Severity::error &&
           (one.code.starts_with("E0") || one.code.starts_with("E42"));
  });
}

project::Listener& terminal() { return standard_error(); }

int exit_code_without_net() { return standard_error().unreadable ? usage : failed; }

int complain(const std::string& text) {
  put(fmt::format("tessera: error: {}\n", printable(text)));
  return failed;
}

int end_output(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  if (!output_failed())
    complain(fmt::format("not all text could be written to standard output: {}", std::strerror(errno)));
  return exit_code == ok ? failed : exit_code;
}

std::string for_output(std::string_view text) {
  return isatty(STDOUT_FILENO) != 0 ? printable(text) : std::string(text);
}

void write_output(const std::string& file, std::string_view text) {
  check_replaceable(file, text);
  const std::string shown = file == "-" ? for_output(text) : std::string();
  if (file == "-") text = shown;
  std::FILE* stream = file == "-" ? stdout : std::fopen(file.c_str(), "wb");
  if (stream == nullptr)
    throw std::runtime_error(fmt::format("cannot write {}: {}", file, std::strerror(errno)));
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const bool closed = stream == stdout ? std::fflush(stream) == 0 : std::fclose(stream) == 0;
  output_failed() = output_failed() || (stream == stdout && (!written || !closed));
  if (!written || !closed)
    throw std::runtime_error(fmt::format("cannot write {}: {}", file, std::strerror(errno)));
}

}  // namespace tessera::cli
