#include "spec/model/behaviour_flow.hpp"

#include <algorithm>

#include "diagnostics/utf8.hpp"
#include "spec/model/endings.hpp"

namespace tessera::spec {
namespace {

using diagnostics::Diagnostics;
using diagnostics::in_quotes;

bool asks_for_error(const Next& entry) {
  return entry.when.kind == When::Kind::error || entry.when.kind == When::Kind::named_error;
}

bool always(const Condition& condition) { return truth_of(condition) == Truth::always; }
bool never(const Condition& condition) { return truth_of(condition) == Truth::never; }

/// "when it is terminal or by a failure"
std::string in_words(const std::vector<Ending>& endings) {
  std::string text;
  for (const Ending ending : endings) {
    if (!text.empty()) text += " or ";
    if (ending == Ending::terminal) text += "as terminal";
    if (ending == Ending::error) text += "by its error condition";
    if (ending == Ending::failure) text += "by a failure";
  }
  return text;
}

void check_entries(const Behaviour& behaviour, const Endings& endings, Diagnostics& out) {
  const auto& next = behaviour.next;
  const auto unconditional =
      std::ranges::find(next, When::Kind::always, [](const Next& entry) { return entry.when.kind; });
  for (const NextId entry : next.ids()) {
    if (endings.can_be_taken(entry)) continue;
    const bool behind = next.begin() + entry.value > unconditional;
    out.warning("W314", next[entry].span,
                behind ? "this entry is never reached: the one before it is always taken"
                       : "this entry is never taken: its condition cannot hold here",
                behind ? "entries are tried in order; put the unconditional one last"
                       : "the constant conditions of the behaviour, and the entries before it, exclude it");
  }
  std::vector<Ending> open;
  for (const Ending ending : all_endings)
    if (endings.none_possible(ending)) open.push_back(ending);
  if (!open.empty())
    out.warning("W312", next.back().span,
                "behaviour " + in_quotes(behaviour.name) + " may end (" + in_words(open) +
                    ") with no entry of 'next' to take",
                "end the list with an entry without 'when'");
}

void check_errors(const Behaviour& behaviour, Diagnostics& out) {
  const bool routed = std::any_of(behaviour.next.begin(), behaviour.next.end(), asks_for_error);
  if (!never(behaviour.error) && !routed) {
    out.warning("W313", behaviour.error.span,
                "no entry of 'next' asks for the error of behaviour " + in_quotes(behaviour.name),
                "route it: next: [{ to: NAME, when: error }, ...]; else an error ends the subsystem and "
                "stops the system");
  }
  if (behaviour.next_given && never(behaviour.terminal) && never(behaviour.error) && !routed) {
    out.warning("W315", behaviour.next.front().span,
                "behaviour " + in_quotes(behaviour.name) +
                    " ends only if its code, a device or its watchdog fails: its 'next' is used only then",
                "give it a 'terminal' condition; or say { to: NAME, when: error } if that is meant");
  }
  if (always(behaviour.error) && behaviour.terminal.kind == Condition::Kind::expressions) {
    out.warning("W323", behaviour.terminal.span,
                "the terminal condition of behaviour " + in_quotes(behaviour.name) +
                    " is never asked: its error condition always holds",
                "an error comes before a terminal condition");
  }
}

/// The behaviours that some run can enter, judging only by `next`.
Numbered<BehaviourId, bool> reachable(const Subsystem& subsystem) {
  Numbered<BehaviourId, bool> seen(subsystem.behaviours.size(), false);
  std::vector<BehaviourId> open{subsystem.start};
  seen[subsystem.start] = true;
  while (!open.empty()) {
    const Behaviour& behaviour = subsystem.behaviours[open.back()];
    const Endings endings(behaviour);
    open.pop_back();
    for (const NextId entry : behaviour.next.ids()) {
      const BehaviourId to = behaviour.next[entry].behaviour;
      if (!to.valid() || seen[to] || !endings.can_be_taken(entry)) continue;
      seen[to] = true;
      open.push_back(to);
    }
  }
  return seen;
}

}  // namespace

void check_behaviour_flow(const Subsystem& subsystem, Diagnostics& out) {
  if (subsystem.behaviours.empty()) return;
  for (const Behaviour& behaviour : subsystem.behaviours) {
    if (behaviour.next.empty()) continue;
    check_entries(behaviour, Endings(behaviour), out);
    check_errors(behaviour, out);
  }
  const Numbered<BehaviourId, bool> seen = reachable(subsystem);
  for (const BehaviourId i : seen.ids()) {
    const Behaviour& behaviour = subsystem.behaviours[i];
    if (seen[i]) continue;
    out.warning(
        "W311", behaviour.span, "behaviour " + in_quotes(behaviour.name) + " is never entered",
        "no chain of 'next' leads to it from " + in_quotes(subsystem.behaviours[subsystem.start].name));
  }
}

}  // namespace tessera::spec
