#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "net/net.hpp"

namespace tessera::server {

/// The marking of a net during a recorded run.
class MarkingTracker {
 public:
  /// The initial marking. net: must outlive it.
  explicit MarkingTracker(const net::Net& net);
  void fire(net::TransitionId transition);
  /// Puts one token into each of these places, and none into the others.
  void set(std::span<const net::PlaceId> places);
  /// The numbers of the places that hold a token.
  [[nodiscard]] std::vector<std::uint32_t> marked() const;

 private:
  const net::Net& net_;
  /// may be below 0 for a moment, because threads write their events with different delays
  std::vector<std::int32_t> tokens_;
};

}  // namespace tessera::server
