#pragma once

#include <vector>

#include "explore/pt_net.hpp"

/// Sets of places that keep a token once they have one, or never get one: facts about the reachable
/// markings that follow from the structure of a net.
namespace tessera::siphons {

/// For each place, whether it is in the set.
using PlaceSet = std::vector<char>;

/// Removes places until the set is a trap: every transition that takes from it also puts into it,
/// so that a trap with a token never loses its last one. The result is the largest trap
/// within the set; it may be empty.
///
/// Linear in the removed places and their neighbours, and in the net.
/// Source: Commoner; Hack, *Analysis of production schemata by Petri nets*, 1972.
void shrink_to_trap(const explore::PtNet& net, PlaceSet& set);

/// The same if only the places in `suspects` may violate the condition.
void shrink_to_trap(const explore::PtNet& net, PlaceSet& set, std::vector<std::uint32_t> suspects);

/// The initially marked place of the set with the lowest number; places() if there is none.
[[nodiscard]] std::uint32_t marked_place(const explore::PtNet& net, const PlaceSet& set);

/// A trap within the set `within` that is marked initially, with few places; empty if there is none.
[[nodiscard]] std::vector<std::uint32_t> small_marked_trap(const explore::PtNet& net, PlaceSet within);

}  // namespace tessera::siphons
