#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tessera::server {

/// The result of one run of a sweep.
struct SweepRow {
  std::string value;  ///< of the parameter, as written; empty: none is varied
  std::uint64_t seed = 0;
  bool failed = false;
  std::string ended;                                     ///< why it ended: "duration", or what has failed
  std::map<std::string, std::optional<double>> numbers;  ///< by measure; nullopt: it was never taken
  std::map<std::string, std::string> units;              ///< of the measures that have one

  /// A row of docs/reference/studio.md.
  [[nodiscard]] nlohmann::json shown() const;
  /// nullopt: `shown` has not made it.
  [[nodiscard]] static std::optional<SweepRow> read(const nlohmann::json& row);
  /// From summary.json of a run, with its measures, faults and overruns.
  [[nodiscard]] static SweepRow of_summary(const nlohmann::json& summary);
};

/// The rows of a sweep in a file, one a line, so that a sweep that was interrupted goes on where it ended. A line that
/// is not whole does not count.
///
/// Threads: one at a time.
class SweepFile {
 public:
  /// file: need not exist.
  explicit SweepFile(std::filesystem::path file);
  /// nullptr: no run with that value and seed is kept. Valid until `add`.
  [[nodiscard]] const SweepRow* find(const std::string& value, std::uint64_t seed) const;
  /// Keeps a row. Returns false if it cannot be written; it is known all the same.
  bool add(SweepRow row);

 private:
  std::filesystem::path file_;
  std::map<std::pair<std::string, std::uint64_t>, SweepRow> rows_;
  std::ofstream out_;
};

}  // namespace tessera::server
