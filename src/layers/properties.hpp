#pragma once

#include <optional>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"
#include "net/property.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

/// The properties of the specification, over places of the net. A path names a place, a page with all places
/// in it, or a channel and one of its states. A buffer may stand for its channel if it has only one.
///
/// pages, net: build(model), and the flat net of it.
/// Errors: E101 names that the net does not have; E112 a path that ends too early, or a buffer of several
/// channels, memory that is not compared; E114 a comparison of something else; E261 to E265 a comparison with no
/// value of the memory cell. One per property and fleet.
[[nodiscard]] std::optional<std::vector<net::Property>> properties(const spec::Model& model,
                                                                   const net::HierarchicalNet& pages,
                                                                   const net::Net& net,
                                                                   diagnostics::Diagnostics& out);

}  // namespace tessera::layers
