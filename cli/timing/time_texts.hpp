// Texts about proved times.
#pragma once

#include "timing/words.hpp"

namespace tessera::cli {

using timing::bound_text;
using timing::least_time_text;
using timing::time_text;

/// The first lines of what is said about times.
inline constexpr const char* assumptions_of_times =
    "times, if no call takes longer than `takes`, nothing fails or ends, and no thread waits for a "
    "processor\n"
    "but as `realtime` says:\n";

}  // namespace tessera::cli
