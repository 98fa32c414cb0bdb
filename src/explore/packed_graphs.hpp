#pragma once

#include <memory>

#include "explore/state_graph.hpp"

namespace tessera::explore {

// The widths for which PackedGraph is instantiated, in two files to share the compile time. Markings of
// other widths are rounded up to the next one.

/// For encodings that prove the net safe; null above 4 words, where make_counting_graph is as good.
[[nodiscard]] std::unique_ptr<StateGraph> make_safe_graph(const PtNet& net, const Encoding& encoding);
/// For any encoding; null above 256 words.
[[nodiscard]] std::unique_ptr<StateGraph> make_counting_graph(const PtNet& net, const Encoding& encoding);

}  // namespace tessera::explore
