// The names of answers, parts and changes in JSON, of the commands and of the studio.
#pragma once

#include "timing/changes.hpp"
#include "timing/declared.hpp"
#include "timing/steps.hpp"

namespace tessera::timing {

[[nodiscard]] const char* word_of(Answer answer);
[[nodiscard]] const char* word_of(Step::Kind kind);
[[nodiscard]] const char* word_of(Change::Kind kind);

}  // namespace tessera::timing
