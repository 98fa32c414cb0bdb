#pragma once

#include <optional>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "net/net.hpp"
#include "spec/model/model.hpp"

namespace tessera::layers {

/// The hierarchical net of a specification: five layers, page by page (design, sections 2 and 3;
/// paper, sec. IV).
///
/// Subjects: Place/Transition `subsystem` is an index into Model::instances; a transition_function's subject
/// indexes Subsystem::behaviours, write/read/elapsed subjects index Model::channels, a next's subject indexes
/// Behaviour::next. Threads: pure. Linear in the net.
[[nodiscard]] std::optional<net::HierarchicalNet> build(const spec::Model& model,
                                                        diagnostics::Diagnostics& out);

/// The place invariants that the net has by construction: one per subsystem, one per branch of a
/// parallel transfer, one per channel, and a signed one per acknowledgement. Together they bound every
/// place by one token.
///
/// net: the flat net of build(model).
[[nodiscard]] std::vector<net::Invariant> invariants(const spec::Model& model,
                                                     const net::HierarchicalNet& pages, const net::Net& net);

}  // namespace tessera::layers
