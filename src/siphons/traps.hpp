#pragma once

#include <vector>

#include "explore/pt_net.hpp"

/// Sets of places that keep a token once they have one, or never get one: what the structure of a net says
/// about its reachable markings.
namespace tessera::siphons {

/// Per place: is it in the set?
using PlaceSet = std::vector<char>;

/// Takes places out until the set is a trap: every transition that takes from it also puts into it, so that a
/// trap with a token never loses its last one. What is left is the largest trap within the set, maybe empty.
///
/// Linear in the places taken out and their surroundings, and in the net.
/// Source: Commoner; Hack, *Analysis of production schemata by Petri nets*, 1972.
void shrink_to_trap(const explore::PtNet& net, PlaceSet& set);

/// The same, when only the places in `suspects` may have become wrong.
void shrink_to_trap(const explore::PtNet& net, PlaceSet& set, std::vector<std::uint32_t> suspects);

/// The initially marked place of the set with the lowest number; places() if there is none.
[[nodiscard]] std::uint32_t marked_place(const explore::PtNet& net, const PlaceSet& set);

/// A trap within the set `within` that is marked initially, with few places; empty if there is none.
[[nodiscard]] std::vector<std::uint32_t> small_marked_trap(const explore::PtNet& net, PlaceSet within);

}  // namespace tessera::siphons
