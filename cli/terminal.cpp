#include "cli/terminal.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace tessera::cli {

bool colour() { return isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr; }

void print(const diagnostics::Diagnostics& diagnostics) {
  std::fputs(diagnostics::render(diagnostics, colour()).c_str(), stderr);
}

int complain(const std::string& text) {
  fmt::print(stderr, "tessera: error: {}\n", text);
  return failed;
}

void write_output(const std::string& file, std::string_view text) {
  std::FILE* stream = file == "-" ? stdout : std::fopen(file.c_str(), "wb");
  if (stream == nullptr)
    throw std::runtime_error(fmt::format("cannot write {}: {}", file, std::strerror(errno)));
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const bool closed = stream == stdout ? std::fflush(stream) == 0 : std::fclose(stream) == 0;
  if (!written || !closed)
    throw std::runtime_error(fmt::format("cannot write {}: {}", file, std::strerror(errno)));
}

Step::Step(std::string what) : what_(std::move(what)), start_(std::chrono::steady_clock::now()) {}

Step::~Step() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Step::progress(std::string_view detail) {
  if (isatty(STDERR_FILENO) == 0 || seconds() < 1) return;
  shown_ = true;
  fmt::print(stderr, "\r\033[K{} {} ({:.0f} s)", what_, detail, seconds());
  std::fflush(stderr);
}

double Step::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace tessera::cli
