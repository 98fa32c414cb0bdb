#pragma once

#include <chrono>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "sim/trace.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// Writes a trace file point by point; what is older than a twentieth of a second of wall time can be read.
/// The same points give the same bytes: numbers have a fixed number of decimals.
class TraceWriter {
 public:
  /// An empty path: writes nothing. Whether the file can be written, finish() says.
  explicit TraceWriter(std::string path);
  [[nodiscard]] bool wanted() const { return !path_.empty(); }
  /// Before the points; the first call counts. robots: bodies with devices; of several there are no points.
  void begin(const std::vector<std::string>& robots);
  void add(const TracePoint& point);
  /// Flushes. Problem: some of it could not be written.
  [[nodiscard]] std::optional<Problem> finish();

 private:
  std::string path_;
  std::string reason_;  ///< why it could not be opened
  std::ofstream file_;
  bool begun_ = false;
  std::chrono::steady_clock::time_point flushed_{};
};

}  // namespace tessera::sim
