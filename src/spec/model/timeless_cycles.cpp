#include "spec/model/timeless_cycles.hpp"

#include <algorithm>

#include "spec/model/endings.hpp"
#include "spec/model/successors.hpp"

namespace tessera::spec {
namespace {

/// Whether a behaviour may follow itself.
bool repeats(const Behaviour& behaviour) {
  return !behaviour.is_group() && truth_of(behaviour.terminal) != Truth::always &&
         truth_of(behaviour.error) != Truth::always;
}

/// Whether one of the behaviours `to` may follow it.
bool passes_on(const Subsystem& subsystem, BehaviourId from, const Numbered<BehaviourId, bool>& to) {
  return std::ranges::any_of(successors(subsystem, from), [&](BehaviourId next) { return to[next]; });
}

/// Removes behaviours after which no remaining behaviour can come, as long as there are any. The rest lies
/// on cycles or leads to them.
Numbered<BehaviourId, bool> endless(const Subsystem& subsystem, const Numbered<BehaviourId, bool>& waits) {
  Numbered<BehaviourId, bool> left(waits.size());
  std::transform(waits.begin(), waits.end(), left.begin(), [](bool one) { return !one; });
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = left.size(); i-- > 0;) {  // behaviours mostly lead to later ones
      const BehaviourId id{static_cast<std::uint32_t>(i)};
      if (!left[i] || repeats(subsystem.behaviours[i]) || passes_on(subsystem, id, left)) continue;
      left[i] = false;
      changed = true;
    }
  }
  return left;
}

}  // namespace

std::vector<BehaviourId> timeless_cycles(const Subsystem& subsystem,
                                         const Numbered<BehaviourId, bool>& waits) {
  const Numbered<BehaviourId, bool> left = endless(subsystem, waits);
  std::vector<BehaviourId> found;
  bool circle_found = false;
  for (const BehaviourId i : left.ids()) {
    if (!left[i] || subsystem.behaviours[i].is_group()) continue;
    // If behaviours only lead to one another, the first one represents the cycle.
    if (!repeats(subsystem.behaviours[i]) && circle_found) continue;
    circle_found = circle_found || !repeats(subsystem.behaviours[i]);
    found.push_back(i);
  }
  return found;
}

}  // namespace tessera::spec
