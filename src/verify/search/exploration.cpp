#include "verify/search/exploration.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "explore/budget.hpp"
#include "reduce/components.hpp"
#include "reduce/reduce.hpp"
#include "verify/search/parts.hpp"

namespace tessera::verify {

std::string sizes(const reduce::Reduced& reduced, const reduce::Components& components) {
  const reduce::Statistics& count = reduced.statistics;
  const auto number = [](std::size_t value) { return std::to_string(value); };
  return number(count.places_before) + " places and " + number(count.transitions_before) +
         " transitions, reduced to " + number(count.places_after) + " and " +
         number(count.transitions_after) + " in " + number(components.all.size()) + " parts of " +
         number(components.kinds) + " kinds";
}

namespace {

using explore::Formula;
using net::PlaceId;
using net::TransitionId;
using Sets = std::vector<std::vector<TransitionId>>;

/// The components of one kind; the first stands for all.
std::vector<std::vector<const reduce::Component*>> by_kind(const reduce::Components& components) {
  std::vector<std::vector<const reduce::Component*>> kinds(components.kinds);
  for (const reduce::Component& component : components.all) kinds[component.kind].push_back(&component);
  std::ranges::stable_sort(kinds, {}, [](const auto& kind) { return kind.front()->places.size(); });
  return kinds;
}

/// A run of the representative as one of another component of its kind.
void append(const std::vector<TransitionId>& trace, const reduce::Component& to,
            std::vector<TransitionId>& all) {
  for (const TransitionId id : trace) all.push_back(to.transitions[id.value]);
}

/// Transitions without any arc are in no component; they never let the net die.
bool has_free_transition(const net::Net& net) {
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    if (net.preset({index}).empty()) return true;
  return false;
}

}  // namespace

Found find_dead(const net::Net& net, PlaceId final_place, const Reducing& how,
                const explore::Limits& limits) {
  const explore::Budget budget(limits);
  reduce::Preserve what;
  what.safe = how.safe;
  if (final_place.valid()) what.observed.push_back(final_place);
  const reduce::Reduced reduced = reduce::reduce(net, what, how.rules);
  const reduce::Components components = reduce::components(reduced.net);
  const PlaceId final_left = final_place.valid() ? reduced.find(final_place).value_or(PlaceId{}) : PlaceId{};
  Found found;
  found.explanation = sizes(reduced, components);
  found.kind = Found::Kind::yes;
  if (has_free_transition(reduced.net)) found.kind = Found::Kind::no;
  std::vector<TransitionId> run;
  for (const auto& kind : by_kind(components)) {
    if (found.kind == Found::Kind::no) break;
    const reduce::Component& first = *kind.front();
    const Part part(reduced.net, std::span(kind).first(1));
    const bool has_final = final_left.valid() && std::ranges::count(first.places, final_left) > 0;
    const Formula is_final = has_final ? part.inside(Formula::marked(final_left)) : Formula::never();
    const explore::Answer answer =
        explore::find_deadlock(explore::PtNet(part.net()), is_final, budget.left());
    found.states += answer.effort.markings;
    found.cut_short = found.cut_short || answer.cut_short;
    if (answer.kind == explore::Answer::Kind::no) found.kind = Found::Kind::no;
    if (answer.kind == explore::Answer::Kind::unknown) {
      found.kind = Found::Kind::unknown;
      found.why = answer.why;
    }
    for (const reduce::Component* component : kind) append(answer.trace.firings, *component, run);
  }
  if (found.kind == Found::Kind::yes) found.trace = reduced.lift(run);
  return found;
}

namespace {

/// Sets of transitions of a net that was reduced and taken apart.
class StuckSearch {
 public:
  StuckSearch(const net::Net& net, const Sets& sets, const Reducing& how, const explore::Limits& limits)
      : budget_(limits),
        reduced_(reduce::reduce(net, {.observed = {}, .sets = sets, .safe = how.safe}, how.rules)),
        components_(reduce::components(reduced_.net, reduced_.sets)) {
    place_members();
  }

  std::vector<Found> result() {
    for (const auto& kind : by_kind(components_)) explore_kind(*kind.front());
    std::vector<Found> all;
    for (const auto& parts : members_) all.push_back(judge(parts));
    return all;
  }

 private:
  /// Transitions of a set within one component, by their numbers in it.
  using Local = std::vector<std::uint32_t>;
  using ComponentId = net::Id<struct ComponentTag>;  // none: of transitions that need no token
  using Parts = std::map<ComponentId, Local>;

  void place_members() {
    std::vector<std::pair<ComponentId, std::uint32_t>> where(reduced_.net.transitions().size());
    for (std::uint32_t component = 0; component < components_.all.size(); ++component) {
      const auto& transitions = components_.all[component].transitions;
      for (std::uint32_t local = 0; local < transitions.size(); ++local)
        where[transitions[local].value] = {ComponentId{component}, local};
    }
    for (const std::vector<TransitionId>& set : reduced_.sets) {
      Parts& parts = members_.emplace_back();
      for (const TransitionId id : set) parts[where[id.value].first].push_back(where[id.value].second);
      for (auto& [component, local] : parts) {
        std::ranges::sort(local);
        if (component.valid()) answers_[{components_.all[component.value].kind, local}];
      }
    }
  }

  void explore_kind(const reduce::Component& first) {
    std::vector<explore::Obligation> obligations;
    std::vector<explore::Answer*> to;
    for (auto& [key, answer] : answers_) {
      if (key.first != first.kind) continue;
      explore::Obligation& obligation = obligations.emplace_back();
      for (const std::uint32_t local : key.second) obligation.any_of.push_back({local});
      to.push_back(&answer);
    }
    if (obligations.empty()) return;
    const reduce::Component* const only = &first;
    const Part part(reduced_.net, std::span(&only, 1));
    const std::vector<explore::Answer> answers =
        explore::can_always_fire(explore::PtNet(part.net()), obligations, budget_.left());
    for (std::size_t index = 0; index < to.size(); ++index) *to[index] = answers[index];
    states_ += answers.front().effort.markings;
  }

  /// The parts of a set are independent: it gets stuck if and only if each of them does.
  Found judge(const Parts& parts) const {
    Found found;
    found.explanation = sizes(reduced_, components_);
    found.states = states_;
    found.kind = Found::Kind::no;
    std::vector<TransitionId> run;
    for (const auto& [component, local] : parts) {
      if (!component.valid()) {  // needs no token
        found.kind = Found::Kind::yes;
        break;
      }
      const explore::Answer& answer = answers_.at({components_.all[component.value].kind, local});
      if (answer.kind == explore::Answer::Kind::yes) {
        found.kind = Found::Kind::yes;
        break;
      }
      if (answer.kind == explore::Answer::Kind::unknown) {
        found.kind = Found::Kind::unknown;
        found.why = answer.why;
      }
      append(answer.trace.firings, components_.all[component.value], run);
    }
    if (found.kind == Found::Kind::no) found.trace = reduced_.lift(run);
    return found;
  }

  explore::Budget budget_;
  reduce::Reduced reduced_;
  reduce::Components components_;
  std::vector<Parts> members_;                                          // per set
  std::map<std::pair<std::uint32_t, Local>, explore::Answer> answers_;  // by kind
  std::uint64_t states_ = 0;
};

}  // namespace

std::vector<Found> find_stuck(const net::Net& net, const Sets& sets, const Reducing& how,
                              const explore::Limits& limits) {
  return StuckSearch(net, sets, how, limits).result();
}

}  // namespace tessera::verify
