// Texts about proved times.
#pragma once

#include <string>

#include "timing/time.hpp"

namespace tessera::cli {

/// The first lines of what is said about times.
inline constexpr const char* assumptions_of_times =
    "times, if no call takes longer than `takes`, nothing fails or ends, and no thread waits for a "
    "processor\n"
    "but as `realtime` says:\n";

/// "82 ms", "1.5 s": at most four digits, rounded up, since a bound must not be told too small.
[[nodiscard]] std::string time_text(timing::Time ns);
/// The same, rounded down, for what takes at least so long.
[[nodiscard]] std::string least_time_text(timing::Time ns);
/// "robot[].control": the members of a fleet have one line, if their verdicts are equal.
[[nodiscard]] std::string without_members(const std::string& name);

}  // namespace tessera::cli
