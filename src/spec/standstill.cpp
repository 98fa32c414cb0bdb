#include "spec/standstill.hpp"

#include <algorithm>

namespace tessera::spec {
namespace {

/// Whether a behaviour may begin another iteration of its own.
bool repeats(const Behaviour& behaviour) {
  return behaviour.terminal.kind != Condition::Kind::always &&
         behaviour.error.kind != Condition::Kind::always;
}

/// Removes, as long as there are any, the behaviours from which nothing that stays can follow: what is left
/// lies on or before a circle.
std::vector<bool> endless(const Subsystem& subsystem, const std::vector<bool>& waits) {
  std::vector<bool> left(waits.size());
  std::transform(waits.begin(), waits.end(), left.begin(), [](bool one) { return !one; });
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = left.size(); i-- > 0;) {  // behaviours mostly lead to later ones
      const Behaviour& behaviour = subsystem.behaviours[i];
      const bool goes_on = repeats(behaviour) ||
                           std::any_of(behaviour.next.begin(), behaviour.next.end(), [&](const Next& next) {
                             return next.behaviour != none && left[next.behaviour];
                           });
      if (!left[i] || goes_on) continue;
      left[i] = false;
      changed = true;
    }
  }
  return left;
}

}  // namespace

std::vector<Index> standing_still(const Subsystem& subsystem, const std::vector<bool>& waits) {
  const std::vector<bool> left = endless(subsystem, waits);
  std::vector<Index> found;
  bool circle_found = false;
  for (Index i = 0; i < left.size(); ++i) {
    if (!left[i]) continue;
    // Of the behaviours that only pass on to one another, the first stands for all.
    if (!repeats(subsystem.behaviours[i]) && circle_found) continue;
    circle_found = circle_found || !repeats(subsystem.behaviours[i]);
    found.push_back(i);
  }
  return found;
}

}  // namespace tessera::spec
