#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <string>

namespace tessera {

/// Captures the standard error stream of this process from now on. It can be read at any time: what gtest captures
/// is lost if another thread writes between the end of one capture and the beginning of the next.
///
/// Only one at a time.
class StderrText {
 public:
  StderrText() : file_(std::tmpfile()), kept_(fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3)) {
    std::fflush(stderr);
    dup2(fileno(file_), STDERR_FILENO);
  }
  StderrText(const StderrText&) = delete;
  StderrText& operator=(const StderrText&) = delete;
  ~StderrText() {
    std::fflush(stderr);
    dup2(kept_, STDERR_FILENO);
    close(kept_);
    std::fclose(file_);
  }

  [[nodiscard]] std::string now() const {
    std::fflush(stderr);
    std::string text;
    std::array<char, 4096> part{};
    while (const ssize_t count =
               pread(fileno(file_), part.data(), part.size(), static_cast<off_t>(text.size()))) {
      if (count < 0) break;
      text.append(part.data(), static_cast<std::size_t>(count));
    }
    return text;
  }
  [[nodiscard]] bool has(const std::string& part) const { return now().find(part) != std::string::npos; }

 private:
  std::FILE* file_;
  int kept_;
};

}  // namespace tessera
