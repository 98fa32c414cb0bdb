#pragma once

#include <optional>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"
#include "net/property.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

/// The properties of the specification, over places of the net. A path names a place, or a page and with it
/// all places in it; a channel and a state of it, which may be given by a buffer if that belongs to one
/// channel.
///
/// pages, net: build(model), and that flattened.
/// Errors: E101 names that the net does not have; E112 a path that ends too early, or a buffer of several
/// channels. One per property and fleet.
[[nodiscard]] std::optional<std::vector<net::Property>> properties(const spec::Model& model,
                                                                   const net::HierarchicalNet& pages,
                                                                   const net::Net& net,
                                                                   diagnostics::Diagnostics& out);

}  // namespace tessera::layers
