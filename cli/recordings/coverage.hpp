#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "project/verification/pipeline.hpp"

namespace tessera::cli {

/// The value of a `--coverage` without a file.
inline constexpr const char* shown_only = "*";

/// The firings of runs of one specification, summed. All members throw std::runtime_error, which names the
/// file, if a part of it cannot be read or is of another net.
class CoverageInput {
 public:
  explicit CoverageInput(const project::Specification& specification);
  ~CoverageInput();
  CoverageInput(const CoverageInput&) = delete;
  CoverageInput& operator=(const CoverageInput&) = delete;

  /// A recording, or results of schedules with coverage.
  void add_file(const std::string& file);
  void add_firings(const std::string& file, const std::string& net,
                   const std::map<std::string, std::uint64_t>& firings, std::uint64_t runs);

 private:
  friend void report_coverage(const CoverageInput& input, const std::string& to, bool shown);
  struct State;
  std::unique_ptr<State> state_;
};

/// to: shown_only, a file for the JSON, or "-". shown: the text goes to standard output.
void report_coverage(const CoverageInput& input, const std::string& to, bool shown);

}  // namespace tessera::cli
