#include "explore/packed_graph.hpp"
#include "explore/packed_graphs.hpp"

namespace tessera::explore {

std::unique_ptr<StateGraph> make_safe_graph(const PtNet& net, const Encoding& encoding) {
  const std::uint32_t words = encoding.words();
  if (words <= 1) return std::make_unique<PackedGraph<1, false>>(net, encoding);
  if (words <= 2) return std::make_unique<PackedGraph<2, false>>(net, encoding);
  if (words <= 3) return std::make_unique<PackedGraph<3, false>>(net, encoding);
  if (words <= 4) return std::make_unique<PackedGraph<4, false>>(net, encoding);
  return nullptr;
}

}  // namespace tessera::explore
