#pragma once

#include <string>
#include <vector>

#include "net/net.hpp"

namespace tessera::verify {

/// The mistakes in `invariants`, one line each: firings that change the weighted sum, and initial markings
/// with another sum. Empty: all are place invariants of the net (y^T C = 0 and y m0 = total).
///
/// Linear in the net and the invariants.
/// Source: Lautenbach, place invariants.
[[nodiscard]] std::vector<std::string> wrong_invariants(const net::Net& net,
                                                        const std::vector<net::Invariant>& invariants);

/// The places that the invariants do not bound by one token.
///
/// A *unit* invariant has no negative weight and a total of at most one, so it bounds the sum of any of its
/// places. A *signed* invariant of total zero says that its positive places together hold as many tokens as
/// its negative ones. It bounds the positive places if the negative ones lie in one unit invariant. A place
/// that is positive in a bounded signed invariant may stand for the negative places of that invariant (a
/// branch of a fork for the first branch).
///
/// Precondition: wrong_invariants() is empty. Linear in the net and the invariants, unless signed invariants
/// are listed long before those on which they depend.
[[nodiscard]] std::vector<net::PlaceId> unbounded_places(const net::Net& net,
                                                         const std::vector<net::Invariant>& invariants);

}  // namespace tessera::verify
