#include "verify/goals.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "reduce/components.hpp"
#include "reduce/reduce.hpp"
#include "verify/budget.hpp"
#include "verify/parts.hpp"

namespace tessera::verify {
namespace {

using explore::Answer;
using explore::Formula;
using net::PlaceId;
using Kind = Found::Kind;

void places_of(const Goal& goal, std::vector<PlaceId>& to) {
  verify::places_of(goal.what, to);
  verify::places_of(goal.then, to);
}

/// The formula with the places of the reduced net. An observed place is never gone.
Formula translated(Formula formula, const reduce::Reduced& reduced) {
  if (formula.kind == Formula::Kind::at_least) formula.node = reduced.find({formula.node})->value;
  for (Formula& part : formula.parts) part = translated(std::move(part), reduced);
  return formula;
}

Goal translated(const Goal& goal, const reduce::Reduced& reduced) {
  return {translated(goal.what, reduced), translated(goal.then, reduced)};
}

Answer explored(Ask question, const explore::PtNet& net, const Goal& goal, const explore::Limits& limits) {
  switch (question) {
    case Ask::reachable:
      return explore::find(net, goal.what, limits);
    case Ask::always_reachable:
      return explore::always_reachable(net, goal.what, limits);
    case Ask::leads_to:
      return explore::leads_to(net, goal.what, goal.then, limits);
  }
  return {};
}

/// Goals of one reduction of a net.
class Search {
 public:
  Search(const net::Net& net, const std::vector<const Goal*>& goals, const Reducing& how)
      : reduced_(reduce::reduce(net, preserving(goals, how.safe), how.rules)),
        components_(reduce::components(reduced_.net)),
        where_(reduced_.net.places().size()) {
    for (std::uint32_t component = 0; component < components_.all.size(); ++component) {
      const auto& places = components_.all[component].places;
      for (std::uint32_t local = 0; local < places.size(); ++local)
        where_[places[local].value] = {component, local};
    }
    for (const Goal* goal : goals) {
      goals_.push_back(translated(*goal, reduced_));
      parts_.push_back(parts_of(goals_.back()));
    }
  }

  /// Do two goals meet in one component?
  [[nodiscard]] bool tangled() const {
    std::vector<bool> seen(components_.all.size(), false);
    for (const auto& parts : parts_)
      for (const std::uint32_t component : parts) {
        if (seen[component]) return true;
        seen[component] = true;
      }
    return false;
  }

  Found answer(std::size_t goal, Ask question, const explore::Limits& limits) {
    std::vector<const reduce::Component*> chosen;
    for (const std::uint32_t component : parts_[goal]) chosen.push_back(&components_.all[component]);
    const Part part(reduced_.net, chosen);
    const auto [known, is_new] = answers_.try_emplace(description(goal));
    Answer& answer = known->second;
    if (is_new) {
      const Goal inside{part.inside(goals_[goal].what), part.inside(goals_[goal].then)};
      answer = explored(question, explore::PtNet(part.net()), inside, limits);
    }
    Found found;
    found.explanation = sizes(reduced_, components_);
    found.states = is_new ? answer.effort.markings : 0;
    found.why = answer.why;
    if (answer.kind == Answer::Kind::unknown) return found;
    found.kind = answer.kind == Answer::Kind::yes ? Kind::yes : Kind::no;
    const bool shown = (found.kind == Kind::yes) == (question == Ask::reachable);
    if (shown) found.trace = reduced_.lift(part.outside(answer.trace.firings));
    return found;
  }

 private:
  static reduce::Preserve preserving(const std::vector<const Goal*>& goals, bool safe) {
    reduce::Preserve what;
    what.safe = safe;
    for (const Goal* goal : goals) places_of(*goal, what.observed);
    std::ranges::sort(what.observed);
    const auto rest = std::ranges::unique(what.observed);
    what.observed.erase(rest.begin(), rest.end());
    return what;
  }

  /// The components that a goal has to do with; equal goals list equal components in the same order.
  [[nodiscard]] std::vector<std::uint32_t> parts_of(const Goal& goal) const {
    std::vector<PlaceId> places;
    places_of(goal, places);
    std::vector<std::uint32_t> parts;
    for (const PlaceId place : places) parts.push_back(where_[place.value].first);
    std::ranges::sort(parts, {},
                      [&](std::uint32_t part) { return std::pair(components_.all[part].kind, part); });
    const auto rest = std::ranges::unique(parts);
    parts.erase(rest.begin(), rest.end());
    return parts;
  }

  /// The kinds of the components and the goal in terms of their places: all that the answer depends on.
  [[nodiscard]] std::string description(std::size_t goal) const {
    std::string text;
    for (const std::uint32_t part : parts_[goal]) text += std::to_string(components_.all[part].kind) + " ";
    describe(goals_[goal].what, parts_[goal], text);
    describe(goals_[goal].then, parts_[goal], text);
    return text;
  }

  void describe(const Formula& formula, const std::vector<std::uint32_t>& parts, std::string& text) const {
    text += "(" + std::to_string(static_cast<int>(formula.kind)) + " ";
    if (formula.kind == Formula::Kind::at_least) {
      const auto [component, local] = where_[formula.node];
      const auto part = std::ranges::find(parts, component) - parts.begin();
      text += std::to_string(part) + " " + std::to_string(local) + " " + std::to_string(formula.tokens);
    }
    for (const Formula& part : formula.parts) describe(part, parts, text);
    text += ")";
  }

  reduce::Reduced reduced_;
  reduce::Components components_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> where_;  // per place: component, number in it
  std::vector<Goal> goals_;
  std::vector<std::vector<std::uint32_t>> parts_;  // per goal
  std::map<std::string, Answer> answers_;          // by description
};

/// Goals that may be equal but for the agents.
std::vector<std::vector<std::size_t>> alike(const net::Net& net, const std::vector<Goal>& goals) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t goal = 0; goal < goals.size(); ++goal) {
    std::vector<PlaceId> places;
    places_of(goals[goal], places);
    std::string signature;
    for (const PlaceId place : places) signature += reduce::template_name(net[place].name) + "\n";
    groups[signature].push_back(goal);
  }
  std::vector<std::vector<std::size_t>> all;
  for (auto& [signature, group] : groups) all.push_back(std::move(group));
  std::ranges::sort(all);
  return all;
}

}  // namespace

std::vector<Found> ask(const net::Net& net, Ask question, const std::vector<Goal>& goals, Kind stop_at,
                       const Reducing& how, const explore::Limits& limits) {
  const Budget budget(limits);
  std::vector<Found> found(goals.size());
  // Whether goals that were looked at together were all answered before the one that ends it.
  const auto all_answered = [&](Search& search, const std::vector<std::size_t>& group) {
    for (std::size_t goal = 0; goal < group.size(); ++goal) {
      found[group[goal]] = search.answer(goal, question, budget.left());
      if (found[group[goal]].kind == stop_at) return false;
    }
    return true;
  };
  for (const std::vector<std::size_t>& group : alike(net, goals)) {
    std::vector<const Goal*> members;
    for (const std::size_t goal : group) members.push_back(&goals[goal]);
    Search together(net, members, how);
    if (members.size() == 1 || !together.tangled()) {
      if (!all_answered(together, group)) return found;
      continue;
    }
    // Fewer observed places leave less of a net that does not fall apart.
    for (const std::size_t goal : group) {
      Search alone(net, {&goals[goal]}, how);
      if (!all_answered(alone, {goal})) return found;
    }
  }
  return found;
}

}  // namespace tessera::verify
