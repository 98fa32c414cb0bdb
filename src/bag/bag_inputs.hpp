#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bag/channel.hpp"

namespace tessera::bag {

/// A real input, and the topic from which it gets its values.
struct WantedInput {
  RosBuffer ros;     ///< of an action: its name, its type, and the definition of feedback and result together
  std::string type;  ///< of the buffer, as tessera/value_encoding.hpp describes
  bool is_action = false;  ///< the progress of the goals that a client has ordered
};

/// The values of real inputs that stand in a bag.
struct BagInputs {
  std::string recording;           ///< the bytes of a file for the option --inputs of a controller
  std::int64_t end_ns = 0;         ///< time of the last value, from the first message of the bag on
  std::uint64_t values = 0;        ///< of all inputs
  std::vector<std::string> notes;  ///< inputs without values, messages that do not fit
};

/// Takes the values of real inputs out of a bag that any program may have written, topic by topic. The progress of
/// the goals of an action stands in its topics `status` and `feedback`. The definitions
/// in the bag say how its messages are encoded; those of the driver serve where the bag has them in another language.
///
/// Errors: no MCAP file, a topic with messages of another type, or of another form than the buffer can have, no
///         topic at all: nullopt and `error`.
[[nodiscard]] std::optional<BagInputs> inputs_of(std::string_view bag, const std::string& system,
                                                 const std::vector<WantedInput>& wanted, std::string& error);

}  // namespace tessera::bag
