#pragma once

#include <optional>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"

namespace tessera::net {

/// The most tokens of an initial marking, and the heaviest arc, that a PNML file may ask for.
inline constexpr std::uint32_t largest_pnml_number = 2147483647;

/// The P/T net of a PNML document (the text of `out`).
///
/// Pages, nested or not, become one flat net; reference nodes are replaced by the nodes that they refer to;
/// parallel arcs add up. An element is called by its name, or by its id if the name is missing or used
/// twice. Names, graphics and tool-specific parts are ignored, and nothing else that could change what the net does
/// (pnml_vocabulary.hpp). Markings and weights are also read as PIPE ("Default,2") and TAPAAL (attributes) write them.
/// Spans refer to the document.
///
/// Errors:  E420 not XML, E421 a document type with declarations of its own (entities are never expanded),
///          E422 not PNML, or no net or several, E423 not a P/T net (coloured, inhibitor, reset and
///          test arcs), E424 a place, a transition or a reference without an id or with one that is taken, E425 a marking or weight that is no number in
///          range, E426 an arc that does not join a place and a transition, E427 a reference that leads
///          nowhere, E428 a part that is not known, or given twice, E429 a part that changes what the net does:
///          time, capacities, priorities. Reports all, then nullopt. Warnings: W421, W422 (pnml_vocabulary.hpp).
/// Threads: pure. Linear in the text up to sorting; no recursion, however deep the pages.
/// Source:  ISO/IEC 15909-2, place/transition nets. Deviation: nets of the core model are read too.
[[nodiscard]] std::optional<Net> read_pnml(diagnostics::Diagnostics& out);

}  // namespace tessera::net
