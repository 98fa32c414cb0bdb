// The verdicts of section 7 of the design and of docs/specification.md, computed
// from every reachable marking.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formula.hpp"

namespace oracle {

/// One net that is judged: with or without exceptions.
class Judge {
 public:
  Judge(FlatNet abstract, std::size_t limit) : net_(std::move(abstract)), graph_(net_, limit) {}

  const FlatNet& net() const { return net_; }
  const StateGraph& graph() const { return graph_; }

  bool has_ended(const Marking& marking, int subsystem) const;
  bool final(const Marking& marking) const { return marking.has(net_.system_out); }

  bool exclusive_channels() const;
  bool deadlock_free() const;
  bool sound_pages() const;
  /// The states in which a subsystem has not ended and fires nothing any more.
  StateGraph::Set stuck(int subsystem) const;
  bool goes_on() const;
  /// The states from which a received channel is never read again although its reader cannot end.
  StateGraph::Set dry(int channel) const;
  bool channels_flow() const;
  /// Paths of the behaviours that never run.
  std::vector<std::string> dead_behaviours() const;

  bool holds(const Specification& specification, const Property& property) const;
  /// The states that violate a universal property; for `leads_to`, the states of F
  /// from which G need not follow.
  StateGraph::Set bad(const CompiledProperty& property, Property::Kind kind) const;

 private:
  FlatNet net_;
  StateGraph graph_;
};

/// Whether a communication model of a specification is sound if each side is used for
/// ever (docs/verification.md).
bool sound_model(const Model& model);

}  // namespace oracle
