#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "explore/bits.hpp"
#include "explore/encoding.hpp"
#include "explore/formula.hpp"
#include "explore/marking_set.hpp"
#include "explore/watch.hpp"

namespace tessera::explore {

/// The reachable markings of a net in one encoding, in breadth-first order. Edges are not stored:
/// successors and predecessors are computed by firing forwards and backwards, and looked up.
///
/// References given to the factory must outlive the graph. Threads: one at a time.
class StateGraph {
 public:
  enum class End : std::uint8_t {
    complete,
    goal,      ///< the last marking is the first in which the goal holds
    outgrown,  ///< a place needs a wider field: outgrown()
    limit      ///< the watch ended the search
  };

  virtual ~StateGraph() = default;

  /// Adds all reachable markings, up to the first in which `goal` is true. Call once, on an empty graph.
  [[nodiscard]] virtual End explore(const Formula& goal, Watch& watch) = 0;

  struct Insertion {
    Index index;
    bool fresh;
  };
  /// Adds one marking, for searches with an order of their own. nullopt: a field is too small (outgrown()).
  [[nodiscard]] virtual std::optional<Insertion> insert(const Marking& marking) = 0;

  [[nodiscard]] virtual std::size_t size() const = 0;
  /// The number of firings from the markings explored so far.
  [[nodiscard]] virtual std::uint64_t edges() const = 0;
  [[nodiscard]] virtual std::size_t bytes() const = 0;
  [[nodiscard]] virtual std::uint32_t outgrown() const = 0;
  [[nodiscard]] virtual Marking marking(Index index) const = 0;
  [[nodiscard]] virtual Tokens most_tokens() const = 0;

  /// The markings in which the formula is true; some are missing if the watch ends it.
  [[nodiscard]] virtual Bits where(const Formula& formula, Watch& watch) const = 0;
  /// Adds to `reached` every marking of `within` (null: any) from which a firing leads into `reached`,
  /// until there is none left. false: the watch ended it. Precondition: explored completely.
  [[nodiscard]] virtual bool close_backward(Bits& reached, const Bits* within, Watch& watch) const = 0;
  /// A shortest run from the initial marking.
  [[nodiscard]] virtual std::vector<TransitionId> run_to(Index index) const = 0;
  struct Run {
    std::vector<TransitionId> firings;
    Index end;
  };
  /// A shortest run from a marking into `target` whose markings before the last are within `within` (null:
  /// any). Precondition: there is one. If the watch ends it, the run is empty.
  [[nodiscard]] virtual Run run_into(Index from, const Bits& target, const Bits* within,
                                     Watch& watch) const = 0;
};

/// nullptr: a marking of the net does not fit into the longest supported code (16,384 bits).
[[nodiscard]] std::unique_ptr<StateGraph> make_state_graph(const PtNet& net, const Encoding& encoding);

using GraphTask = std::function<StateGraph::End(StateGraph&)>;

/// A graph for a net whose bounds are not known.
class GrowingGraph {
 public:
  explicit GrowingGraph(const PtNet& net);
  /// Repeats the task on an empty graph, each time with wider fields, until all fields suffice. Returns the
  /// last end of the task, or End::limit if the fields cannot be widened; then the watch says why.
  [[nodiscard]] StateGraph::End run(const GraphTask& task, Watch& watch);
  /// Whether the last run has a graph; it has none if markings are too long.
  [[nodiscard]] bool has_graph() const { return graph_ != nullptr; }
  [[nodiscard]] StateGraph& graph() const { return *graph_; }

 private:
  const PtNet& net_;
  Growth growth_;
  std::unique_ptr<Encoding> encoding_;
  std::unique_ptr<StateGraph> graph_;
};

}  // namespace tessera::explore
