#pragma once

#include <string>

namespace tessera::sim {

/// A message of the engine about an MJCF file, for people: on one line, and with the words "needs a newer
/// MuJoCo" if the cause is an element that only later versions know.
///
///     needs a newer MuJoCo: `kv` of `position` (line 12)
[[nodiscard]] std::string explained(const std::string& engine_message);

}  // namespace tessera::sim
