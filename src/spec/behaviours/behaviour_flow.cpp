#include "spec/behaviours/behaviour_flow.hpp"

#include <algorithm>
#include <string>

#include "diagnostics/utf8.hpp"
#include "spec/behaviours/complete_lists.hpp"
#include "spec/model/endings.hpp"
#include "spec/model/member.hpp"
#include "spec/model/successors.hpp"

namespace tessera::spec {
namespace {

using diagnostics::Diagnostics;
using diagnostics::in_quotes;

bool always(const Condition& condition) { return truth_of(condition) == Truth::always; }
/// Not the implied one.
std::size_t written_entries(const Behaviour& behaviour) {
  return behaviour.next.size() - (behaviour.next.back().implied ? 1 : 0);
}

/// An earlier entry of the same kind that is always taken.
bool is_behind(const Behaviour& behaviour, NextId entry) {
  const bool of_error = names_error(behaviour.next[entry]);
  const When::Kind all = of_error ? When::Kind::error : When::Kind::always;
  return std::any_of(behaviour.next.begin(), behaviour.next.begin() + entry.value,
                     [&](const Next& earlier) { return earlier.when.kind == all; });
}

/// The entry that an ending without error takes, or took before Endings asked for the name of an error.
std::string target(const Subsystem& subsystem, const Behaviour& behaviour) {
  for (const Next& entry : behaviour.next)
    if (entry.behaviour.valid() && !names_error(entry))
      return std::string(subsystem.behaviours[entry.behaviour].label());
  return std::string(behaviour.label());
}

/// The edit after which an error leads to `to`.
std::string routing(const Subsystem& subsystem, const Behaviour& behaviour, const std::string& to) {
  const std::string entry = "{ to: " + to + ", when: error }";
  const Next& first = behaviour.next.front();
  if (written_entries(behaviour) != 1 || first.when.kind != When::Kind::always)
    return "add " + entry + " to 'next'";
  if (!Endings(behaviour).possible(Ending::terminal)) return "write next: " + entry;
  const std::string other(first.behaviour.valid() ? subsystem.behaviours[first.behaviour].label() : "end");
  return "write next: [" + entry + ", " + other + "]";
}

/// The `end` that nobody has written is never taken. A group may be left by `until` around it alone; then there is
/// nothing to change.
void check_default_end(const Behaviour& behaviour, Diagnostics& out) {
  if (behaviour.is_group()) return;
  out.warning(
      "W314", behaviour.terminal.span,
      "behaviour " + in_quotes(behaviour.name) +
          " has no 'next', and never leads to end by itself: this condition cannot hold",
      "'until' around it still leaves the group; write a condition that can hold, or leave 'terminal' out");
}

void check_entries(const Behaviour& behaviour, const Endings& endings, Diagnostics& out) {
  for (std::uint32_t number = 0; number < written_entries(behaviour); ++number) {
    const NextId entry{number};
    if (endings.can_be_taken(entry)) continue;
    // W313 and W315 are about these.
    const bool constant = behaviour.next[entry].when.kind == When::Kind::never;
    if (!constant && !names_error(behaviour.next[entry]) && !endings.possible(Ending::terminal)) continue;
    if (!behaviour.next_given && !behaviour.next[entry].inherited) {
      check_default_end(behaviour, out);
      continue;
    }
    const bool behind = is_behind(behaviour, entry);
    out.warning("W314", behaviour.next[entry].span,
                behind ? "this entry is never reached: the one before it is always taken"
                       : "this entry is never taken: its condition cannot hold here",
                behind ? "entries are tried in order; put the unconditional one last"
                       : "the constant conditions of the behaviour, and the entries before it, exclude it");
  }
  // Counters that stop an entry are another matter: check_counters.
  const Endings uncounted(
      behaviour, [](const Expression& one) { return truth_of(one); },
      [](const Next&) { return Truth::always; });
  if (!asks_what_is_known(behaviour) && uncounted.none_possible(Ending::terminal))
    out.warning(
        "W312", behaviour.next[written_entries(behaviour) - 1].span,
        "behaviour " + in_quotes(behaviour.name) + " may end as terminal with no entry of 'next' to take",
        "end the list with an entry without 'when'");
}

/// "the error of behaviour 'work'", or the named ones that no entry takes; empty: all are taken.
std::string unrouted_errors(const Behaviour& behaviour, const Endings& endings) {
  if (!endings.unrouted(Ending::error)) return {};
  const std::string of_all = "the error of behaviour " + in_quotes(behaviour.name);
  if (std::ranges::none_of(behaviour.next, [](const Next& one) { return names_error(one) && !one.implied; }))
    return of_all;
  std::string names;
  for (const ExpressionId id : behaviour.error.expressions.ids()) {
    const bool named = std::ranges::any_of(behaviour.next, [&](const Next& one) {
      return one.when.kind == When::Kind::named_error && one.when.expression == id;
    });
    if (!named && truth_of(behaviour.error.expressions[id]) != Truth::never)
      names += (names.empty() ? "" : " or ") + in_quotes(behaviour.error.expressions[id].name);
  }
  return names.empty() ? of_all : names + ", an error of behaviour " + in_quotes(behaviour.name);
}

void check_errors(const Subsystem& subsystem, const Behaviour& behaviour, const Endings& endings,
                  Diagnostics& out) {
  const std::string to = target(subsystem, behaviour);
  const std::string unrouted = unrouted_errors(behaviour, endings);
  const bool routes_failures = !endings.unrouted(Ending::failure);
  if (!unrouted.empty())
    out.warning("W313", behaviour.error.span, "no entry of 'next' asks for " + unrouted,
                "it ends the subsystem and stops the system; to go on with " + in_quotes(to) + ", " +
                    routing(subsystem, behaviour, to) +
                    (to == behaviour.label() ? "" : "; or route it to end, if that is meant"));
  const auto unused = std::ranges::find_if(
      behaviour.next, [](const Next& entry) { return !names_error(entry) && !entry.implied; });
  if (unrouted.empty() && behaviour.next_given && !endings.possible(Ending::terminal) &&
      unused != behaviour.next.end()) {
    const bool ends = !unused->behaviour.valid();
    if (behaviour.is_group())
      out.warning("W381", unused->span,
                  "no behaviour of group " + in_quotes(behaviour.name) +
                      " leads to end: this entry of 'next' is never taken",
                  "write next: end in the behaviour after which the group is done");
    else
      out.warning("W315", unused->span,
                  "behaviour " + in_quotes(behaviour.name) + " never ends as terminal: " +
                      (ends ? "its 'next' is used only if it fails" : "this entry of 'next' is never taken"),
                  std::string("give it a 'terminal' condition") +
                      (ends || routes_failures
                           ? ""
                           : "; or, if a failure shall lead there, " + routing(subsystem, behaviour, to)));
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
    const BehaviourId from = open.back();
    open.pop_back();
    for (const BehaviourId to : successors(subsystem, from)) {
      if (seen[to]) continue;
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
    // The members of a fleet have the same text.
    if (written_entries(behaviour) == 0 || (behaviour.member && behaviour.member->number > 0)) continue;
    const Endings endings(behaviour);
    check_entries(behaviour, endings, out);
    check_errors(subsystem, behaviour, endings, out);
  }
  const Numbered<BehaviourId, bool> seen = reachable(subsystem);
  for (const BehaviourId i : seen.ids()) {
    const Behaviour& behaviour = subsystem.behaviours[i];
    if (seen[i] || (behaviour.parent.valid() && !seen[behaviour.parent])) continue;
    const auto more = others_of_family(subsystem.behaviours, i, [&](BehaviourId id) { return !seen[id]; });
    if (!more) continue;
    out.warning(
        "W311", behaviour.span, "behaviour " + in_quotes(behaviour.name) + *more + " is never entered",
        "no chain of 'next' leads to it from " + in_quotes(subsystem.behaviours[subsystem.start].name));
  }
}

}  // namespace tessera::spec
