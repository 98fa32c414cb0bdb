#pragma once

#include <optional>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"

namespace tessera::net {

/// Flattens a hierarchical net: replaces every page by its net, recursively, then merges fusion sets.
///
/// A token that is put into a page enters the input place of its net; the page is left by taking the token
/// from the output place of its net. Places are in the order of the pages, with fused places last.
/// Transitions are in the order of the pages.
///
/// Errors:  E401 a page without a net, E402 members of a fusion set disagree on the marking, E403 two
///          operations in one fusion set, E404 a page that is reached twice or never, E405 a page that is
///          fused, is marked or has an operation. Reports all, then nullopt.
/// Threads: pure. Linear in the net.
/// Source:  Figat & Zielinski, ICRA 2019, sec. II (pages, fusion places).
[[nodiscard]] std::optional<Net> flatten(const HierarchicalNet& net, diagnostics::Diagnostics& out);

}  // namespace tessera::net
