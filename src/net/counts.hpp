#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "net/net.hpp"

namespace tessera::net {

/// The size of a net, as a flat net and layer by layer. A page counts in the net that contains it. Fused
/// places count in `places` of the flat net and in no layer.
struct Counts {
  struct Layer {
    std::size_t places = 0, transitions = 0, pages = 0;
    bool operator==(const Layer&) const = default;
  };
  std::size_t places = 0, fused = 0, transitions = 0, arcs = 0;  ///< of the flat net
  std::array<Layer, layer_count> layers;                         ///< by net::Layer

  bool operator==(const Counts&) const = default;
};

[[nodiscard]] Counts count(const HierarchicalNet& pages, const Net& net);

/// "system", "agent", ...
[[nodiscard]] const char* name_of(Layer layer);

/// {"flat": {"places", "fused", "transitions", "arcs"},
/// "layers": {"system": {"places", "transitions", "pages"}, ...}}
[[nodiscard]] std::string to_json(const Counts& counts);

}  // namespace tessera::net
