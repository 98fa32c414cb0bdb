#pragma once

#include <string>

#include "statistics/results.hpp"

namespace tessera::statistics {

/// The results for people: how many runs failed, a row per kind of what went wrong and per subsystem or check,
/// each with its interval, and the commands that make the first of each again.
[[nodiscard]] std::string to_table(const Results& results);

/// "1.2 %", with three digits.
[[nodiscard]] std::string percent(double share);

}  // namespace tessera::statistics
