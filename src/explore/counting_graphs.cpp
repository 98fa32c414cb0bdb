#include "explore/packed_graph.hpp"
#include "explore/packed_graphs.hpp"

namespace tessera::explore {

std::unique_ptr<StateGraph> make_counting_graph(const PtNet& net, const Encoding& encoding) {
  const std::uint32_t words = encoding.words();
  if (words <= 1) return std::make_unique<PackedGraph<1, true>>(net, encoding);
  if (words <= 2) return std::make_unique<PackedGraph<2, true>>(net, encoding);
  if (words <= 4) return std::make_unique<PackedGraph<4, true>>(net, encoding);
  if (words <= 8) return std::make_unique<PackedGraph<8, true>>(net, encoding);
  if (words <= 32) return std::make_unique<PackedGraph<32, true>>(net, encoding);
  if (words <= 256) return std::make_unique<PackedGraph<256, true>>(net, encoding);
  return nullptr;
}

}  // namespace tessera::explore
