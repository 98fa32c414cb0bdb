#pragma once

#include <string>
#include <vector>

#include "net/net.hpp"

/// What place invariants say about pages and channels.
namespace tessera::verify {

/// The first place that no unit invariant keeps apart from the input and the output of a page that contains
/// it; empty: every page is entered once at a time and left empty.
///
/// Precondition for both: every invariant is one of the net (wrong_invariants is empty). Linear in the net
/// times the depth of its pages.
[[nodiscard]] std::string unsound_page(const net::HierarchicalNet& pages, const net::Net& net,
                                       const std::vector<net::Invariant>& invariants);

/// The first channel whose writes and reads no unit invariant keeps apart; empty: there is none.
[[nodiscard]] std::string shared_memory(const net::Net& net, const std::vector<net::Invariant>& invariants);

}  // namespace tessera::verify
