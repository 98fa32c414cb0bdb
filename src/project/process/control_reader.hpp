#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "tessera/control_messages.hpp"

namespace tessera::project {

/// A whole message of a controller.
struct ControlMessage {
  std::string line;                    ///< as it came, without its end
  std::optional<ControlLine> content;  ///< nullopt: the line is from another version, or malformed
  std::string bytes;                   ///< those that a PieceHead or SceneHead precedes
};

/// Cuts the bytes of a control socket into messages.
///
/// Threads: one.
class ControlReader {
 public:
  void add(std::string_view bytes);
  /// The next message; nullopt: the rest of it has not come yet, or never comes (`exceeds_limits`).
  [[nodiscard]] std::optional<ControlMessage> next();
  /// Whether more bytes wait to be read than a controller sends, or a head announces more than it sends. If no
  /// call of `next` ends that, the connection is of no use any more.
  [[nodiscard]] bool exceeds_limits() const;

 private:
  std::string unread_;
  std::size_t begin_ = 0;  ///< of the next message
  bool announces_too_much_ = false;
};

}  // namespace tessera::project
