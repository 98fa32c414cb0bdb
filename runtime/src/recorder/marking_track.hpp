#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nets/flat_net.hpp"
#include "tessera/ids.hpp"
#include "tessera/recording.hpp"

namespace tessera {

/// The marking of the flat net after the recorded firings so far. A segment of a recording begins with it,
/// so that the segment can be checked without earlier ones.
///
/// Threads: one at a time.
class MarkingTrack {
 public:
  /// channels: per transition of the net, the channel it touches, or none.
  MarkingTrack(const FlatNet& net, std::vector<ChannelId> channels);

  /// Whether the input places hold tokens, and the version is the next of its channel: every firing before it
  /// has been recorded. Always true once the marking is unknown.
  [[nodiscard]] bool may_fire(const Event& firing) const;
  /// If the transition cannot fire because events are missing, the marking becomes unknown.
  void fire(const Event& firing);
  [[nodiscard]] bool known() const { return known_; }
  /// From now on, firings come in any order.
  void forget() { known_ = false; }
  /// Names of the places that hold a token, one per line.
  [[nodiscard]] std::string marked() const;

 private:
  struct Arcs {
    std::uint32_t inputs, outputs, end;  // into arcs_
    ChannelId channel;
  };
  std::vector<std::string> names_;
  std::vector<bool> marked_;
  std::vector<std::uint32_t> arcs_;
  std::vector<Arcs> transitions_;
  Numbered<ChannelId, std::uint32_t> versions_;
  bool known_ = true;
};

}  // namespace tessera
