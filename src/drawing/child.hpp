#pragma once

#include <string>

namespace tessera::drawing {

/// What graphviz's `dot` answers to a graph, as its JSON with positions.
///
/// Throws LayoutError when there is no such program or it fails.
[[nodiscard]] std::string run_dot(const std::string& graph);

}  // namespace tessera::drawing
