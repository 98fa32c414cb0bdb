// The verdicts of section 7 of the design and of docs/reference/specification.md, computed
// from every reachable marking.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiled_formula.hpp"
#include "oracle/nets/reachability_graph.hpp"

namespace oracle {

/// One net that is judged: with or without exceptions.
class Judge {
 public:
  Judge(FlatNet abstract, std::size_t limit)
      : net_(std::move(abstract)), petri_net_(petri_net(net_)), graph_(petri_net_, limit) {}

  const FlatNet& net() const { return net_; }
  const ReachabilityGraph& graph() const { return graph_; }

  /// nullopt if the transition is not enabled.
  std::optional<Marking> fire(int transition, const Marking& marking) const {
    return fired(petri_net_.transitions[static_cast<std::size_t>(transition)], marking);
  }

  bool has_ended(const Marking& marking, int subsystem) const;
  bool final(const Marking& marking) const { return has_token(marking, net_.system_out); }

  bool exclusive_channels() const;
  bool deadlock_free() const;
  bool sound_pages() const;
  /// The states in which a subsystem has not ended and can never fire again.
  ReachabilityGraph::States stuck(int subsystem) const;
  bool goes_on() const;
  /// The states from which a channel is never read again, while its reader cannot end; of a channel that is
  /// received.
  ReachabilityGraph::States dry(int channel) const;
  bool channels_flow() const;
  /// Paths of the behaviours that never run.
  std::vector<std::string> dead_behaviours() const;

  bool holds(const Specification& specification, const Property& property) const;
  /// The states that show that a universal property is violated; of `leads_to` those of F from which G need
  /// not follow.
  ReachabilityGraph::States bad(const CompiledProperty& property, Property::Kind kind) const;

 private:
  FlatNet net_;
  PetriNet petri_net_;
  ReachabilityGraph graph_;
};

/// Whether a communication model of a specification is sound if each side is used for
/// ever (docs/theory/verification.md).
bool sound_model(const Model& model);

}  // namespace oracle
