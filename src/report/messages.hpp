#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tessera/recording.hpp"

namespace tessera::report {

/// A message of a run: log line, fault or end. Equal messages of a subsystem are combined.
struct Message {
  std::int64_t first_ns = 0, last_ns = 0;
  std::uint64_t count = 0;
  enum class Weight : std::uint8_t { bad, warning, plain } weight = Weight::plain;
  std::string who;   ///< path of the subsystem, or "system"
  std::string what;  ///< the text, shortened
};

struct Messages {
  std::vector<Message> shown;  ///< in the order of their first times
  std::uint64_t hidden = 0;    ///< number of other messages
};

/// At most `most` messages: first faults, errors and the end, then warnings, then others; of equal
/// weight, the first and the last.
[[nodiscard]] Messages messages_of(const Recording& recording, std::size_t most);

}  // namespace tessera::report
