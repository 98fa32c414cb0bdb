#pragma once

#include <chrono>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "sim/trace.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// Writes a trace file point by point. Points reach the file within a twentieth of a second of real time. The
/// same points give the same bytes: numbers have a fixed number of decimals.
class TraceWriter {
 public:
  /// path: empty: no file is written. finish() reports whether the file could be written.
  explicit TraceWriter(std::string path);
  [[nodiscard]] bool wanted() const { return !path_.empty(); }
  /// Call it before the points; only the first call counts. robots: bodies with devices; if there are
  /// several, no points are written.
  void begin(const std::vector<std::string>& robots);
  void add(const TracePoint& point);
  /// Flushes. Problem: a part of it could not be written.
  [[nodiscard]] std::optional<Problem> finish();

 private:
  std::string path_;
  std::string reason_;  ///< why it could not be opened
  std::ofstream file_;
  bool begun_ = false;
  std::chrono::steady_clock::time_point flushed_{};
};

}  // namespace tessera::sim
