#include "explore/state_graph.hpp"

#include "explore/packed_graphs.hpp"

namespace tessera::explore {
std::unique_ptr<StateGraph> make_state_graph(const PtNet& net, const Encoding& encoding) {
  if (encoding.proves_safe())
    if (auto graph = make_safe_graph(net, encoding)) return graph;
  return make_counting_graph(net, encoding);
}

GrowingGraph::GrowingGraph(const PtNet& net) : net_(net), growth_(net) {}

StateGraph::End GrowingGraph::run(const GraphTask& task, Watch& watch) {
  while (true) {
    graph_.reset();  // releases its memory before the next graph is made
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
