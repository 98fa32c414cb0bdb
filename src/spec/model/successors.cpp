#include "spec/model/successors.hpp"

#include "spec/model/endings.hpp"

namespace tessera::spec {
namespace {

void add_after(const Subsystem& subsystem, BehaviourId of, std::vector<BehaviourId>& found) {
  const Behaviour& behaviour = subsystem.behaviours[of];
  const Endings endings(behaviour);
  bool leaves_group = false;
  for (const NextId entry : behaviour.next.ids()) {
    if (!endings.can_be_taken(entry)) continue;
    if (const BehaviourId to = behaviour.next[entry].behaviour; to.valid())
      found.push_back(to);
    else
      leaves_group = behaviour.parent.valid();
  }
  if (leaves_group) add_after(subsystem, behaviour.parent, found);
}

}  // namespace

std::vector<BehaviourId> successors(const Subsystem& subsystem, BehaviourId of) {
  std::vector<BehaviourId> found;
  if (const auto& group = subsystem.behaviours[of].group)
    found.push_back(group->start);
  else
    add_after(subsystem, of, found);
  return found;
}

}  // namespace tessera::spec
