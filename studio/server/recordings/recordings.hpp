#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/analysis/analysis.hpp"
#include "server/analysis/spec_file.hpp"

namespace tessera::server {

/// The recordings in a project: of the last `tessera simulate` or `run`, of the studio's runs, and *.tsr
/// beside the specification. One in segments (`--record-limit`) is one, as far as it is left.
///
/// Threads: any.
class Recordings {
 public:
  Recordings(SpecFile& file, Analyses& analyses) : file_(file), analyses_(analyses) {}

  static constexpr std::size_t most_firings = 200'000, most_samples = 400'000, most_points = 20'000;

  /// [{"name", "bytes", "modified", "system", "net_hash", "clock", "duration"}]
  [[nodiscard]] std::string list() const;
  struct Span {
    std::int64_t from_ns = INT64_MIN, to_ns = INT64_MAX;
  };
  /// {"net_hash", "system", "subsystems", "marking", "firings", "dropped", "first", "last", "total",
  /// "values", "cut", "truncated", "path", "track"} of docs/studio.md: at most most_firings, most_samples (of
  /// values, together) and most_points of the span. nullopt: there is none of that name. Throws
  /// std::runtime_error when it cannot be read.
  [[nodiscard]] std::optional<std::string> content(const std::string& name, Span span) const;

 private:
  /// By name. Nothing is a file here that is a symbolic link, or in a folder that is one.
  [[nodiscard]] std::map<std::string, std::filesystem::path> files() const;
  [[nodiscard]] nlohmann::json known_summary_of(const std::filesystem::path& file) const;
  SpecFile& file_;
  Analyses& analyses_;
  struct KnownSummary {
    std::int64_t bytes = 0, modified_ns = 0;  ///< of the newest file
    nlohmann::json summary;
  };
  mutable std::mutex mutex_;  ///< of what follows
  mutable std::map<std::filesystem::path, KnownSummary> known_;
};

}  // namespace tessera::server
