#include "spec/model/former_routes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "diagnostics/utf8.hpp"
#include "spec/model/endings.hpp"

namespace tessera::spec {
namespace {

using diagnostics::in_quotes;

/// Whether an error or a failure could be taken by an entry that names none.
bool took_errors(const Next& entry) {
  return entry.when.kind == When::Kind::always || entry.when.kind == When::Kind::expression;
}

/// Whether an entry behind `end` without `when` now takes errors that this `end` has taken.
bool named_behind(const Behaviour& behaviour, NextId end) {
  const Endings endings(behaviour);
  for (const NextId entry : behaviour.next.ids()) {
    const Next& next = behaviour.next[entry];
    if (entry.value <= end.value || !names_error(next) || next.implied || !next.behaviour.valid()) continue;
    if (endings.taken(entry, Ending::error) != Truth::never ||
        endings.taken(entry, Ending::failure) != Truth::never)
      return true;
  }
  return false;
}

/// The entries from `first` on that could take an error or a failure, up to one that took every one.
std::vector<NextId> candidates(const Behaviour& behaviour, NextId first) {
  std::vector<NextId> found;
  for (const NextId entry : behaviour.next.ids()) {
    const Next& next = behaviour.next[entry];
    if (entry.value < first.value || (!took_errors(next) && next.when.kind != When::Kind::error)) continue;
    found.push_back(entry);
    if (next.when.kind != When::Kind::expression) break;
  }
  return found;
}

std::string name_of_target(const Subsystem& subsystem, BehaviourId to) {
  return to.valid() ? in_quotes(subsystem.behaviours[to].name) : "'end'";
}

/// Whether N330 is about it: no entry takes its failures now, and no warning says so.
bool is_noted(const Behaviour& behaviour) {
  const Endings endings(behaviour);
  return truth_of(behaviour.terminal) != Truth::always && endings.possible(Ending::terminal) &&
         endings.unrouted(Ending::failure) && !endings.unrouted(Ending::error);
}

bool is_of_on_error(const Subsystem& subsystem, const Behaviour& behaviour) {
  const auto leads = [&](const Behaviour& from) {
    return std::ranges::any_of(from.next, [&](const Next& next) {
      return next.inherited && next.behaviour.valid() &&
             (&from == &behaviour || &subsystem.behaviours[next.behaviour] == &behaviour);
    });
  };
  return std::ranges::any_of(subsystem.behaviours, leads);
}

/// Entries with conditions that took errors before the entry that names them.
void note_conditions(const Subsystem& subsystem, diagnostics::Diagnostics& out) {
  std::string names;
  const Next* first = nullptr;
  for (const Behaviour& behaviour : subsystem.behaviours) {
    const std::optional<FormerRoute> route = former_route(subsystem, behaviour);
    if (!route || route->certain || Endings(behaviour).unrouted(Ending::failure)) continue;
    names += (names.empty() ? "" : ", ") + in_quotes(behaviour.name);
    if (first == nullptr) first = &behaviour.next[route->before];
  }
  if (first != nullptr)
    out.note("N332", first->span, "an entry with a condition takes no errors and failures: that of " + names,
             "if it shall take an error, give that error a name: error: { NAME: ... }, and { to: ..., when: "
             "NAME }");
}

void note(const Subsystem& subsystem, diagnostics::Diagnostics& out) {
  constexpr std::size_t shown = 4;
  std::vector<std::pair<const Behaviour*, FormerRoute>> changed;
  for (const Behaviour& behaviour : subsystem.behaviours)
    if (const auto route = former_route(subsystem, behaviour); route && is_noted(behaviour))
      changed.emplace_back(&behaviour, *route);
  if (changed.empty()) return;
  std::string changes;
  for (std::size_t at = 0; at < std::min(shown, changed.size()); ++at) {
    const auto& [behaviour, route] = changed[at];
    changes += (at == 0 ? "" : ", nor ") + in_quotes(behaviour->name) +
               (at == 0 ? " does not go on to " : " to ") +
               (route.certain ? name_of_target(subsystem, route.to) : "what its conditions chose");
  }
  if (changed.size() > shown) changes += ", and so with " + std::to_string(changed.size() - shown) + " more";
  const auto& [first, route] = changed.front();
  const std::string to =
      route.to.valid() ? subsystem.behaviours[route.to].name : std::string(route.certain ? "end" : "NAME");
  out.note(
      "N330", first->next[route.before].span,
      "after a failure " + changes + ": the subsystem ends, and the run fails",
      "a failure is an exception, an error of a device or a call that takes too long; to go on after one "
      "of " +
          in_quotes(first->name) + ", add { to: " + to +
          ", when: error } to its 'next'; { to: end, when: error } agrees with the end");
}

}  // namespace

std::optional<FormerRoute> former_route(const Subsystem& subsystem, const Behaviour& behaviour) {
  // There were neither groups nor behaviours for each member of a fleet.
  if (behaviour.is_group() || behaviour.parent.valid() || behaviour.member) return std::nullopt;
  if (std::ranges::any_of(behaviour.next, [](const Next& next) { return next.member.has_value(); }))
    return std::nullopt;
  if (is_of_on_error(subsystem, behaviour)) return std::nullopt;
  FormerRoute route{.before = {}};
  for (const NextId entry : behaviour.next.ids()) {
    const Next& next = behaviour.next[entry];
    if (next.implied || next.when.kind == When::Kind::error) return std::nullopt;
    if (!took_errors(next)) continue;
    route.before = entry;
    const std::vector<NextId> taken = candidates(behaviour, entry);
    route.to = next.behaviour;
    const When::Kind last = behaviour.next[taken.back()].when.kind;
    route.certain = last != When::Kind::expression && std::ranges::all_of(taken, [&](NextId one) {
                      return behaviour.next[one].behaviour == route.to;
                    });
    if (!route.certain) route.to = {};
    if (route.certain && !route.to.valid() && !named_behind(behaviour, entry)) return std::nullopt;
    const auto written = std::ranges::count(behaviour.next, false, &Next::implied);
    route.no_terminal = !Endings(behaviour).possible(Ending::terminal) && written == 1;
    return route;
  }
  return std::nullopt;
}

void note_former_routes(const Model& model, diagnostics::Diagnostics& out) {
  for (const Definition& definition : model.definitions)
    for (const Subsystem& subsystem : definition.subsystems) {
      note(subsystem, out);
      note_conditions(subsystem, out);
    }
}

}  // namespace tessera::spec
