#pragma once

#include <string>
#include <vector>

#include "statistics/results.hpp"
#include "tessera/result.hpp"

namespace tessera::statistics {

/// Results with the name of their file.
struct NamedResults {
  std::string file;
  Results results;
};

/// All runs together. The whole goes from the lowest seed to the highest of all wholes.
///
/// Problem: they differ in what was run, or a seed is in two of them. other_builds: controllers of the same
/// net whose programs differ are taken as the same. Precondition: there is at least one.
[[nodiscard]] Result<Results> merge(const std::vector<NamedResults>& all, bool other_builds = false);

/// The missing parts of the whole, a line each: "part 3/20: seeds 101 to 150". Empty: none.
[[nodiscard]] std::vector<std::string> missing_parts(const Results& results);

}  // namespace tessera::statistics
