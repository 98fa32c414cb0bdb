#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/recording.hpp"
#include "tessera/value_text.hpp"

namespace tessera::replay {

/// The name under which the length of a sequence is shown: "boxes.size()"; "size()" if it is the whole value.
[[nodiscard]] std::string length_path(const std::string& sequence);

/// Follows the values of buffers through the entries of a recording.
class ValueTrack {
 public:
  /// Keeps a reference to the recording's header.
  explicit ValueTrack(const Recording& recording);

  struct Change {
    std::uint32_t number = 0;  ///< index into Recording::buffers
    const Recording::Buffer& buffer;
    ValueEvent event;
    std::string_view bytes;  ///< what the buffer holds now; for a hashed value, its size and hash
    bool hashed = false;
    const ValueLayout* layout;  ///< nullptr: the type is not known
  };
  /// nullopt: the entry is no value. Entries of one subsystem must come in their order. Valid until
  /// the next call.
  [[nodiscard]] std::optional<Change> follow(const Recording::Entry& entry);

  struct Value {
    std::string_view bytes;  ///< empty: no value yet
    bool hashed = false;
    const ValueLayout* layout;  ///< nullptr: the type is not known
  };
  /// The value that a buffer, given by its number, holds now. Valid until the next call of `follow`.
  [[nodiscard]] Value value(std::uint32_t buffer) const;

 private:
  struct Held {
    std::string bytes;
    bool hashed = false;
    std::optional<ValueLayout> layout;
  };
  const Recording& recording_;
  std::vector<Held> held_;
};

/// "{linear: 0.3, angular: 0}", "no value", "48000 bytes, hash 9f...".
[[nodiscard]] std::string text_of(const ValueTrack::Change& change);

}  // namespace tessera::replay
