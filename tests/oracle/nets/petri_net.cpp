#include "oracle/nets/petri_net.hpp"

namespace oracle {
namespace {

/// Most transitions are not enabled, so this is asked before the marking is copied.
bool one_is_short(const std::vector<Arc>& inputs, const Marking& marking) {
  for (const Arc& arc : inputs)
    if (marking[arc.place] < arc.weight) return true;
  return false;
}

}  // namespace

std::optional<Marking> fired(const PetriNet::Transition& transition, const Marking& marking) {
  if (transition.never || one_is_short(transition.inputs, marking)) return std::nullopt;
  Marking next = marking;
  for (const Arc& arc : transition.inputs) {
    if (next[arc.place] < arc.weight) return std::nullopt;
    next[arc.place] -= arc.weight;
  }
  for (const Arc& arc : transition.outputs) next[arc.place] += arc.weight;
  return next;
}

}  // namespace oracle
