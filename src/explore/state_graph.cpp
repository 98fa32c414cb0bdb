#include "explore/state_graph.hpp"

#include "explore/packed_graph.hpp"

namespace tessera::explore {
namespace {

template <bool Counters>
std::unique_ptr<StateGraph> graph_of_width(const PtNet& net, const Encoding& encoding) {
  // The widths between are rounded up: one instantiation each is what they cost.
  const std::uint32_t words = encoding.words();
  if (words <= 1) return std::make_unique<PackedGraph<1, Counters>>(net, encoding);
  if (words <= 2) return std::make_unique<PackedGraph<2, Counters>>(net, encoding);
  if (words <= 3) return std::make_unique<PackedGraph<3, Counters>>(net, encoding);
  if (words <= 4) return std::make_unique<PackedGraph<4, Counters>>(net, encoding);
  if (words <= 8) return std::make_unique<PackedGraph<8, Counters>>(net, encoding);
  if (words <= 32) return std::make_unique<PackedGraph<32, Counters>>(net, encoding);
  if (words <= 256) return std::make_unique<PackedGraph<256, Counters>>(net, encoding);
  return nullptr;
}

}  // namespace

std::unique_ptr<StateGraph> make_state_graph(const PtNet& net, const Encoding& encoding) {
  return encoding.proves_safe() ? graph_of_width<false>(net, encoding) : graph_of_width<true>(net, encoding);
}

GrowingGraph::GrowingGraph(const PtNet& net) : net_(net), growth_(net) {}

StateGraph::End GrowingGraph::run(const GraphTask& task, Watch& watch) {
  while (true) {
    graph_.reset();  // before its successor is there
    encoding_ = std::make_unique<Encoding>(growth_.encoding());
    graph_ = make_state_graph(net_, *encoding_);
    if (!graph_) {
      watch.give_up("one marking of this net takes more than 16384 bits");
      return StateGraph::End::limit;
    }
    const StateGraph::End end = task(*graph_);
    if (end != StateGraph::End::outgrown) return end;
    if (!growth_.widen(graph_->outgrown())) {
      watch.give_up("a place holds more than 4294967295 tokens");
      return StateGraph::End::limit;
    }
  }
}

}  // namespace tessera::explore
