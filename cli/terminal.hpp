#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "diagnostics/diagnostics.hpp"

namespace tessera::cli {

/// The command's exit codes.
inline constexpr int ok = 0, failed = 1, usage = 2, unknown = 3, interrupted = 130;

/// Standard error is a terminal that takes colours (NO_COLOR is honoured).
[[nodiscard]] bool colour();

/// All diagnostics to standard error.
void print(const diagnostics::Diagnostics& diagnostics);

/// "tessera: error: TEXT" to standard error; returns `failed`, so that a command can end with it.
int complain(const std::string& text);

/// Writes a file, or standard output for "-". Throws std::runtime_error with path and reason.
void write_output(const std::string& file, std::string_view text);

/// A line on standard error that appears when a step takes longer than a second and goes when it is done.
/// Prints nothing when standard error is no terminal.
class Step {
 public:
  explicit Step(std::string what);
  ~Step();
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;
  /// To be called now and then; detail replaces what was shown behind the step's name.
  void progress(std::string_view detail);
  [[nodiscard]] double seconds() const;

 private:
  std::string what_;
  std::chrono::steady_clock::time_point start_;
  bool shown_ = false;
};

}  // namespace tessera::cli
