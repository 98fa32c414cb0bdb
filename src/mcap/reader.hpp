#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "mcap/records.hpp"

namespace tessera::mcap {

/// A message together with what describes it.
struct ReadMessage {
  const Message& message;
  const Channel& channel;
  const Schema* schema;  ///< nullptr: the channel has none
};

/// The receivers of what a file contains; an empty one is left out.
struct Receivers {
  std::function<void(const ReadMessage&)> message{};
  std::function<void(const Attachment&)> attachment{};
  std::function<void(const Metadata&)> metadata{};
  /// Something may be missing between what was received before and what comes next.
  std::function<void()> gap{};
};

/// The state in which a file was found.
struct Condition {
  bool is_mcap = false;        ///< it begins as a file of this format does
  bool is_complete = false;    ///< it ends as the format demands; false: it was cut off, or is still written
  std::uint64_t chunks = 0;    ///< whole ones
  std::uint64_t damaged = 0;   ///< places at which bytes were damaged and left out
  std::uint64_t messages = 0;  ///< those received
  std::uint64_t unknown = 0;   ///< left out, because nothing describes their channel
  /// Whether it is complete and without damage.
  [[nodiscard]] bool is_whole() const { return is_complete && damaged == 0 && unknown == 0; }
  /// "it was cut off; 2 damaged places were left out"; empty: it is whole.
  [[nodiscard]] std::string told() const;
};

/// Reads a file from its beginning to its end, in the order of the file. It reads any bytes safely. A chunk whose
/// check sum is wrong is left out. After damage, it looks for the next whole chunk, so that every whole chunk
/// of the file is read. Records of unknown kinds are skipped. Messages beside chunks are read only if no chunk stands
/// before them: a message has no check sum of its own, so that a damaged record may look like one.
///
/// Threads: pure, but for the receivers.
Condition read(std::string_view file, const Receivers& receivers);

}  // namespace tessera::mcap
