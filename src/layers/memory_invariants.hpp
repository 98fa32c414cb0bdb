#pragma once

#include <vector>

#include "net/net.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

/// Memory whose values are the members of a large fleet (KnownFacts::values_in): if only certain behaviours run while a
/// cell has a value, and it has no other then, these behaviours and the other values exclude each other.
///
/// tokens: per instance, the invariant that says where the token of the subsystem is.
[[nodiscard]] std::vector<net::Invariant> memory_invariants(const spec::Model& model,
                                                            const net::HierarchicalNet& pages,
                                                            const net::Net& net,
                                                            const std::vector<net::Invariant>& tokens);

}  // namespace tessera::layers
