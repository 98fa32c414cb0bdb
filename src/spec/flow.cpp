#include "spec/flow.hpp"

#include <algorithm>

#include "diagnostics/utf8.hpp"

namespace tessera::spec {
namespace {

using diagnostics::Diagnostics;
using diagnostics::quoted;

bool asks_for_error(const Next& entry) {
  return entry.when.kind == When::Kind::error || entry.when.kind == When::Kind::named_error;
}

bool is_unconditional(const Next& entry) { return entry.when.kind == When::Kind::always; }

bool never(const Condition& condition) { return condition.kind == Condition::Kind::never; }

void check_entries(const Behaviour& behaviour, Diagnostics& out) {
  const auto& next = behaviour.next;
  const auto last = std::find_if(next.begin(), next.end(), is_unconditional);
  if (last != next.end()) {
    for (auto behind = last + 1; behind != next.end(); ++behind) {
      out.warning("W314", behind->span, "this entry is never reached: the one before it is always taken",
                  "entries are tried in order; put the unconditional one last");
    }
  } else if (!always_continues(behaviour)) {
    out.warning("W312", next.back().span,
                "behaviour " + quoted(behaviour.name) + " may end with no entry of 'next' to take",
                "end the list with an entry without 'when'");
  }
}

void check_errors(const Behaviour& behaviour, Diagnostics& out) {
  const bool routed = std::any_of(behaviour.next.begin(), behaviour.next.end(), asks_for_error);
  if (!never(behaviour.error) && !routed) {
    out.warning("W313", behaviour.error.span,
                "no entry of 'next' asks for the error of behaviour " + quoted(behaviour.name),
                "route it: next: [{ to: NAME, when: error }, ...]; else an error ends the subsystem and "
                "stops the system");
  }
  if (behaviour.next_given && never(behaviour.terminal) && never(behaviour.error) && !routed) {
    out.warning("W315", behaviour.next.front().span,
                "behaviour " + quoted(behaviour.name) + " never ends, so its 'next' is never used",
                "give it a 'terminal' or an 'error' condition");
  }
}

/// Which behaviours some run can enter, going by `next` alone.
std::vector<bool> reachable(const Subsystem& subsystem) {
  std::vector<bool> seen(subsystem.behaviours.size(), false);
  std::vector<Index> open{subsystem.start};
  seen[subsystem.start] = true;
  while (!open.empty()) {
    const Behaviour& behaviour = subsystem.behaviours[open.back()];
    open.pop_back();
    for (const Next& entry : behaviour.next) {
      if (entry.behaviour == none || seen[entry.behaviour]) continue;
      seen[entry.behaviour] = true;
      open.push_back(entry.behaviour);
    }
  }
  return seen;
}

}  // namespace

void check_flow(const Subsystem& subsystem, Diagnostics& out) {
  if (subsystem.behaviours.empty()) return;
  for (const Behaviour& behaviour : subsystem.behaviours) {
    if (behaviour.next.empty()) continue;
    check_entries(behaviour, out);
    check_errors(behaviour, out);
  }
  const std::vector<bool> seen = reachable(subsystem);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Behaviour& behaviour = subsystem.behaviours[i];
    if (seen[i]) continue;
    out.warning("W311", behaviour.span, "behaviour " + quoted(behaviour.name) + " is never entered",
                "no chain of 'next' leads to it from " + quoted(subsystem.behaviours[subsystem.start].name));
  }
}

}  // namespace tessera::spec
