#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// Sets of places of a net, one of which always holds the only token: a memory is full, or empty, or in use; or
/// something that a subsystem knows has one of its values.
///
/// Threads: const members from any thread.
class TokenSets {
 public:
  /// Those of the invariants that the net has, and that are about channels or facts.
  TokenSets(const net::Net& net, const std::vector<net::Invariant>& invariants);

  /// The sets with this place.
  [[nodiscard]] const std::vector<std::size_t>& with(net::PlaceId place) const;
  [[nodiscard]] const std::vector<net::PlaceId>& operator[](std::size_t set) const { return sets_[set]; }
  /// The places to which a transition that needs nothing else moves the token of this place.
  [[nodiscard]] const std::vector<net::PlaceId>& next(net::PlaceId place) const;

 private:
  std::vector<std::vector<net::PlaceId>> sets_;
  std::map<net::PlaceId, std::vector<std::size_t>> with_;
  std::map<net::PlaceId, std::vector<net::PlaceId>> next_;
};

}  // namespace tessera::verify
