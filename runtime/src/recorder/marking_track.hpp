#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nets/flat_net.hpp"
#include "tessera/recording.hpp"

namespace tessera {

/// The marking of the flat net after the firings of a recording so far: a segment of a recording begins with
/// it, so that it can be checked without those before.
///
/// Threads: one at a time.
class MarkingTrack {
 public:
  /// channels: per transition of the net, the channel it touches, or none.
  static constexpr std::uint32_t none = UINT32_MAX;
  MarkingTrack(const FlatNet& net, std::vector<std::uint32_t> channels);

  /// Its places hold tokens, and its version is the next of its channel: all that it follows from has fired.
  /// Always so once the marking is not known any more.
  [[nodiscard]] bool may_fire(const Event& firing) const;
  /// Of one that may not fire, because events are missing, the marking is not known any more.
  void fire(const Event& firing);
  [[nodiscard]] bool known() const { return known_; }
  /// From now on firings come in any order.
  void forget() { known_ = false; }
  /// Names of the places that hold a token, a line each.
  [[nodiscard]] std::string marked() const;

 private:
  struct Arcs {
    std::uint32_t inputs, outputs, end;  // into arcs_
    std::uint32_t channel;
  };
  std::vector<std::string> names_;
  std::vector<bool> marked_;
  std::vector<std::uint32_t> arcs_;
  std::vector<Arcs> transitions_;
  std::vector<std::uint32_t> versions_;  // per channel
  bool known_ = true;
};

}  // namespace tessera
