#pragma once

#include <optional>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"

namespace tessera::net {

/// The flat net of a hierarchical one: every page replaced by its net, recursively, then fusion sets merged.
///
/// A token put into a page enters its net's input place; the page is left by taking the token from its net's
/// output place. Places come in the order of the pages, fused places last; transitions in the order of the
/// pages.
///
/// Errors:  E401 a page without a net, E402 members of a fusion set disagree on marking, E403 two operations
/// in one
///          fusion set, E404 a page reached twice or never, E405 a page that is fused, marked or has an
///          operation. Reports all, then nullopt.
/// Threads: pure. Linear in the net.
/// Source:  Figat & Zielinski, ICRA 2019, sec. II (pages, fusion places).
[[nodiscard]] std::optional<Net> flatten(const HierarchicalNet& net, diagnostics::Diagnostics& out);

}  // namespace tessera::net
