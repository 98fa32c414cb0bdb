#pragma once

#include <string>

namespace tessera::drawing {

/// Runs graphviz's `dot` on a graph and returns its JSON with positions.
///
/// Throws LayoutError if the program does not exist or fails.
[[nodiscard]] std::string run_dot(const std::string& graph);

}  // namespace tessera::drawing
