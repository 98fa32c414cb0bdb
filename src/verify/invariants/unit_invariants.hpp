#pragma once

#include <cstdint>
#include <vector>

#include "explore/formula.hpp"
#include "net/net.hpp"

namespace tessera::verify {

/// The unit invariants: no negative weight, and a total of at most one. No two places of one of them are
/// marked at once.
class UnitInvariants {
 public:
  /// Precondition: every invariant is one of the net (wrong_invariants is empty).
  UnitInvariants(const net::Net& net, const std::vector<net::Invariant>& invariants);

  /// The unit invariants that count a place, in ascending order.
  [[nodiscard]] const std::vector<std::uint32_t>& of(net::PlaceId place) const { return of_[place.value]; }

  /// Do the invariants exclude every marking in which the formula is true? false: it remains open.
  ///
  /// Precondition: the formula asks for places only. Tries the ways in which the formula can be true, as long
  /// as they are not too many.
  [[nodiscard]] bool exclude(const explore::Formula& formula) const;

 private:
  friend class Refutation;
  struct Unit {
    std::int64_t total = 0;
    std::uint32_t places = 0;
  };
  std::vector<Unit> units_;
  std::vector<std::vector<std::uint32_t>> of_;  // per place, into units_
};

}  // namespace tessera::verify
