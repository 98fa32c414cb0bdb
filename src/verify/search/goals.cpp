#include "verify/search/goals.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "explore/budget.hpp"
#include "reduce/components.hpp"
#include "reduce/reduce.hpp"
#include "verify/search/parts.hpp"

namespace tessera::verify {
namespace {

using explore::Formula;
using net::PlaceId;

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

explore::Answer explored(Ask question, const explore::PtNet& net, const Goal& goal,
                         const explore::Limits& limits) {
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

/// The same formula with negations of places only, so that it comes apart into as many parts as possible.
Formula with_negations_inside(Formula formula, bool negated = false) {
  if (formula.kind == Formula::Kind::negation)
    return with_negations_inside(Formula(std::move(formula.parts.front())), !negated);
  const bool is_list = formula.kind == Formula::Kind::all || formula.kind == Formula::Kind::any;
  if (!is_list) return negated ? Formula::negation(std::move(formula)) : formula;
  if (negated) formula.kind = formula.kind == Formula::Kind::all ? Formula::Kind::any : Formula::Kind::all;
  for (Formula& part : formula.parts) part = with_negations_inside(std::move(part), negated);
  return formula;
}

/// An answer about a part of a goal, with a run of the reduced net that shows it, if it is of the kind
/// that runs show.
struct Outcome {
  Found::Kind kind = Found::Kind::unknown;
  std::string why{};
  std::vector<net::TransitionId> run{};
};

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
      Goal here = translated(*goal, reduced_);
      here.what = with_negations_inside(std::move(here.what));
      goals_.push_back(std::move(here));
    }
  }

  /// Do two goals meet in one component?
  [[nodiscard]] bool tangled() const {
    std::vector<bool> seen(components_.all.size(), false);
    for (const Goal& goal : goals_)
      for (const std::uint32_t component : parts_of(goal)) {
        if (seen[component]) return true;
        seen[component] = true;
      }
    return false;
  }

  Found answer(std::size_t goal, Ask question, const explore::Budget& budget) {
    const std::uint64_t before = states_;
    Outcome outcome = solve(goals_[goal], question, budget);
    Found found;
    found.kind = outcome.kind;
    found.why = std::move(outcome.why);
    found.explanation = sizes(reduced_, components_);
    found.states = states_ - before;
    if (found.kind == kind_with_run(question)) found.trace = reduced_.lift(outcome.run);
    return found;
  }

 private:
  static Found::Kind kind_with_run(Ask question) {
    return question == Ask::reachable ? Found::Kind::yes : Found::Kind::no;
  }

  /// Components are independent: what each can reach on its own, they can reach together, and a goal out of
  /// reach in one stays so whatever the others do.
  Outcome solve(const Goal& goal, Ask question, const explore::Budget& budget) {
    const bool is_list = goal.what.kind == Formula::Kind::all || goal.what.kind == Formula::Kind::any;
    if (question == Ask::leads_to || !is_list) return look_up(goal, question, budget);
    const std::vector<Goal> independent = independent_parts(goal.what);
    if (independent.size() < 2) return look_up(goal, question, budget);
    const Found::Kind settles = goal.what.kind == Formula::Kind::any ? Found::Kind::yes : Found::Kind::no;
    Outcome together;
    together.kind = settles == Found::Kind::yes ? Found::Kind::no : Found::Kind::yes;
    for (const Goal& part : independent) {
      Outcome outcome = solve(part, question, budget);
      if (outcome.kind == settles) return outcome;
      if (outcome.kind == Found::Kind::unknown) {
        together.kind = Found::Kind::unknown;
        together.why = std::move(outcome.why);
      }
      together.run.insert(together.run.end(), outcome.run.begin(), outcome.run.end());
    }
    return together;
  }

  /// The parts of a list, those together that share a component.
  [[nodiscard]] std::vector<Goal> independent_parts(const Formula& list) const {
    std::vector<std::vector<Formula>> groups;
    std::vector<std::optional<std::size_t>> group_of(components_.all.size());
    for (const Formula& part : list.parts) {
      const std::vector<std::uint32_t> components = parts_of({part});
      std::vector<Formula> joined{part};
      std::set<std::size_t> joins;
      for (const std::uint32_t component : components)
        if (group_of[component]) joins.insert(*group_of[component]);
      for (const std::size_t group : joins) {
        std::ranges::move(groups[group], std::back_inserter(joined));
        groups[group].clear();
      }
      if (!joins.empty())
        for (std::optional<std::size_t>& group : group_of)
          if (group && joins.contains(*group)) group = groups.size();
      for (const std::uint32_t component : components) group_of[component] = groups.size();
      groups.push_back(std::move(joined));
    }
    std::vector<Goal> goals;
    for (std::vector<Formula>& parts : groups) {
      if (parts.empty()) continue;
      Formula what = std::move(parts.front());
      if (parts.size() > 1) {
        parts.front() = std::move(what);
        what = Formula{list.kind, 0, 1, std::move(parts)};
      }
      goals.push_back({std::move(what)});
    }
    return goals;
  }

  Outcome look_up(const Goal& goal, Ask question, const explore::Budget& budget) {
    const std::vector<std::uint32_t> components = parts_of(goal);
    std::vector<const reduce::Component*> chosen;
    for (const std::uint32_t component : components) chosen.push_back(&components_.all[component]);
    const Part part(reduced_.net, chosen);
    const auto [known, is_new] = answers_.try_emplace(description(goal, components));
    explore::Answer& answer = known->second;
    if (is_new) {
      const Goal inside{part.inside(goal.what), part.inside(goal.then)};
      answer = explored(question, explore::PtNet(part.net()), inside, budget.left());
      states_ += answer.effort.markings;
    }
    if (answer.kind == explore::Answer::Kind::unknown) return {Found::Kind::unknown, answer.why};
    const Found::Kind kind = answer.kind == explore::Answer::Kind::yes ? Found::Kind::yes : Found::Kind::no;
    if (kind != kind_with_run(question)) return {kind};
    return {kind, {}, part.outside(answer.trace.firings)};
  }

  static reduce::Preserve preserving(const std::vector<const Goal*>& goals, bool safe) {
    reduce::Preserve what;
    what.safe = safe;
    for (const Goal* goal : goals) places_of(*goal, what.observed);
    std::ranges::sort(what.observed);
    what.observed.erase(std::unique(what.observed.begin(), what.observed.end()), what.observed.end());
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
    parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
    return parts;
  }

  /// The kinds of the components and the goal in terms of their places: all that the answer depends on.
  [[nodiscard]] std::string description(const Goal& goal, const std::vector<std::uint32_t>& parts) const {
    std::string text;
    for (const std::uint32_t part : parts) text += std::to_string(components_.all[part].kind) + " ";
    describe(goal.what, parts, text);
    describe(goal.then, parts, text);
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
  std::map<std::string, explore::Answer> answers_;  // by description
  std::uint64_t states_ = 0;
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

std::vector<Found> ask(const net::Net& net, Ask question, const std::vector<Goal>& goals,
                       std::optional<Found::Kind> stop_at, const Reducing& how,
                       const explore::Limits& limits) {
  const explore::Budget budget(limits);
  std::vector<Found> found(goals.size());
  for (Found& one : found) one.why = "the time is over";
  // false: it is settled, or there is no time for more.
  const auto go_on = [&](Search& search, const std::vector<std::size_t>& group) {
    for (std::size_t goal = 0; goal < group.size(); ++goal) {
      if (budget.spent()) return false;
      found[group[goal]] = search.answer(goal, question, budget);
      if (found[group[goal]].kind == stop_at) return false;
    }
    return true;
  };
  for (const std::vector<std::size_t>& group : alike(net, goals)) {
    std::vector<const Goal*> members;
    for (const std::size_t goal : group) members.push_back(&goals[goal]);
    Search together(net, members, how);
    if (members.size() == 1 || !together.tangled()) {
      if (!go_on(together, group)) return found;
      continue;
    }
    // Fewer observed places leave less of a net that does not fall apart.
    for (const std::size_t goal : group) {
      Search alone(net, {&goals[goal]}, how);
      if (!go_on(alone, {goal})) return found;
    }
  }
  return found;
}

}  // namespace tessera::verify
