// Times in words: the names of answers, parts and changes in JSON, and the texts of times and of fleets, of the
// commands and of the studio.
#pragma once

#include <string>

#include "timing/changes.hpp"
#include "timing/declared.hpp"
#include "timing/steps.hpp"

namespace tessera::timing {

[[nodiscard]] const char* word_of(Answer answer);
[[nodiscard]] const char* word_of(Step::Kind kind);
[[nodiscard]] const char* word_of(Change::Kind kind);

/// "82 ms", "1.5 s": at most four digits, rounded up, since a bound must not be told too small.
[[nodiscard]] std::string time_text(Time time);
/// The same, rounded down, for what takes at least so long.
[[nodiscard]] std::string least_time_text(Time time);
/// "82 ms", or "no bound".
[[nodiscard]] std::string bound_text(Time time);

}  // namespace tessera::timing
