#pragma once

#include <string>

#include "network/messages.hpp"

namespace tessera {

/// A number for a start of `process`: the time in nanoseconds, and at least one more than the number of the
/// last start that was recorded in the same folder, where the new one is stored.
///
/// recording: its file; empty: the number is not stored.
[[nodiscard]] network::Incarnation new_incarnation(const std::string& recording, const std::string& process);

}  // namespace tessera
