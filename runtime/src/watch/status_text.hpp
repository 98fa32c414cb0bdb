#pragma once

#include <cstddef>
#include <string>

#include "tessera/control_messages.hpp"

namespace tessera {

/// The two texts that a process sends over the network for display: lines of monitor_protocol.hpp. Without memory,
/// marked places and files: these are for the machine of the process.
struct StatusTexts {
  std::string brief;  ///< without lists
  std::string whole;
};
/// most_bytes: of a text. The whole one leaves out the last members of its longest lists until it fits, and says
/// how many (Snapshot::left_out).
[[nodiscard]] StatusTexts status_texts(Snapshot snapshot, std::size_t most_bytes);

}  // namespace tessera
