// Texts about proved times.
#pragma once

#include <string>

#include "timing/time.hpp"

namespace tessera::cli {

/// "82 ms", "1.5 s": at most four digits, rounded up, since a bound must not be told too small.
[[nodiscard]] std::string time_text(timing::Time ns);
/// "robot[].control": the members of a fleet have one line, if their verdicts are equal.
[[nodiscard]] std::string without_members(const std::string& name);

}  // namespace tessera::cli
