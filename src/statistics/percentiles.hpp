#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "statistics/results.hpp"

namespace tessera::statistics {

/// The samples between which a percentile lies, by their numbers in ascending order, from 1 on.
struct Ranks {
  std::optional<std::uint64_t> low, high;  ///< nullopt: there are too few samples to bound it on that side
};

/// The ranks of the samples that bound the percentile `share` of a distribution, with at least this two-sided confidence,
/// whatever the distribution is. Preconditions: 0 < share < 1, count > 0, 0 < confidence < 1.
/// Source: order statistics and the binomial distribution (David and Nagaraja, Order Statistics, 2003, section 7.1).
[[nodiscard]] Ranks ranks_of_percentile(double share, std::uint64_t count, double confidence);

/// How many runs ended by themselves, and rows of the time that they took and of the amounts that runs used. Empty: no
/// run ended by itself, and nothing was used.
[[nodiscard]] std::string distribution_rows(const Results& results);

}  // namespace tessera::statistics
