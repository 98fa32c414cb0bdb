#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>

#include "server/analysis/analysis.hpp"
#include "server/analysis/spec_file.hpp"
#include "server/recordings/recording_notes.hpp"

namespace tessera::server {

/// The recordings in a project: that of the last `tessera simulate` or `run`, those of the studio's runs, and
/// *.tsr beside the specification. The existing segments of a recording with a limit count as one recording.
///
/// Threads: any.
class Recordings {
 public:
  Recordings(SpecFile& file, Analyses& analyses) : file_(file), analyses_(analyses) {}

  static constexpr std::size_t most_firings = 200'000, most_samples = 400'000, most_points = 20'000,
                               most_notices = 10'000;

  /// [{"name", "bytes", "modified", "system", "net_hash", "clock", "duration", "notes"}]
  [[nodiscard]] std::string list() const;
  struct Span {
    std::int64_t from_ns = INT64_MIN, to_ns = INT64_MAX;
  };
  /// {"net_hash", "system", "subsystems", "marking", "firings", "dropped", "first", "last", "total",
  /// "values", "arrivals", "lacks_beginning", "cut", "truncated", "path", "notices", "track", "scene"} of
  /// docs/reference/studio.md, within the time span: at most most_firings, most_samples (of all values together) and most_points. nullopt: no recording has that
  /// name. Throws std::runtime_error if it cannot be read.
  [[nodiscard]] std::optional<std::string> content(const std::string& name, Span span) const;

  /// Replaces the notes of a recording (RecordingNotes::write). nullopt: no recording has that name.
  [[nodiscard]] std::optional<RecordingNotes::Outcome> write_notes(const std::string& name,
                                                                   const Notes& notes,
                                                                   const std::string& revision);

  /// {"frames": [[t, base64]...], "until"} of docs/reference/studio.md: the poses in the time span, those at its
  /// beginning first, at most about most_pose_bytes. nullopt: no recording has that name. Throws
  /// std::runtime_error if it cannot be read.
  [[nodiscard]] std::optional<std::string> poses(const std::string& name, Span span) const;
  static constexpr std::size_t most_pose_bytes = 1'500'000;
  /// {"arrays": [[t, {path: base64 or null}]...], "until"} of docs/reference/studio.md: the arrays of numbers
  /// that devices gave in the time span, those at its beginning first, at most about most_array_bytes and ten times a second.
  /// nullopt: no recording has that name. Throws std::runtime_error if it cannot be read.
  [[nodiscard]] std::optional<std::string> arrays(const std::string& name, Span span) const;
  static constexpr std::size_t most_array_bytes = 4'000'000;
  /// The part of the specification's net that the recorded run has reached: docs/reference/studio.md. nullopt: no
  /// recording has that name. Throws std::runtime_error if it cannot be read, or is of another net.
  [[nodiscard]] std::optional<std::string> coverage(const std::string& name) const;
  /// How old commands were in it, and its worst cases: the answer of POST /api/timing/measured, or why there is none.
  /// nullopt: no recording has that name. Throws std::runtime_error if it cannot be read.
  [[nodiscard]] std::optional<std::variant<nlohmann::json, std::string>> measured_times(
      const std::string& name, const spec::Model& model) const;
  /// The glTF file of the scene beside a recording; nullopt: none has it.
  [[nodiscard]] std::optional<std::string> scene(const std::string& hash) const;

 private:
  /// The files by name. Symbolic links, and files in a folder that is one, do not count.
  [[nodiscard]] std::map<std::string, std::filesystem::path> files() const;
  [[nodiscard]] nlohmann::json known_summary_of(const std::filesystem::path& file) const;
  SpecFile& file_;
  Analyses& analyses_;
  RecordingNotes notes_;
  struct KnownSummary {
    std::int64_t bytes = 0, modified_ns = 0;  ///< of the newest file
    nlohmann::json summary;
  };
  mutable std::mutex mutex_;  ///< guards the following members
  mutable std::map<std::filesystem::path, KnownSummary> known_;
};

}  // namespace tessera::server
