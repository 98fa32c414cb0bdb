#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "project/build/controller.hpp"

namespace tessera::project {

/// The lines of a source of the user that have code.
struct LineCoverage {
  std::filesystem::path file;  ///< relative to the project
  std::size_t lines = 0;
  std::vector<std::uint32_t> missed;  ///< those that no run has reached, in order
};

/// Forgets what earlier runs have reached. Before programs of that build folder run.
void clear_line_coverage(const Specification& specification);

/// The lines that programs built with BuildOptions::coverage have reached since then, for all sources in
/// src/, sorted by file. Asks gcov. Throws std::runtime_error if that fails.
[[nodiscard]] std::vector<LineCoverage> line_coverage(const Specification& specification);

/// "57, 60-62"
[[nodiscard]] std::string ranges_of(const std::vector<std::uint32_t>& lines);

}  // namespace tessera::project
