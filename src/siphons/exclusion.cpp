#include "siphons/exclusion.hpp"

#include <map>
#include <string>
#include <utility>

#include "explore/units.hpp"
#include "siphons/clauses.hpp"
#include "siphons/traps.hpp"

namespace tessera::siphons {
namespace {

using explore::Formula;
using explore::PtNet;
using explore::Tokens;
using explore::Touch;

/// The question about a marking and the known facts, as clauses.
class Statement {
 public:
  Statement(const PtNet& net, Clauses& clauses)
      : net_(net), clauses_(clauses), single_(net.places(), 0), units_(explore::find_units(net)) {
    for (std::uint32_t place = 0; place < net.places(); ++place) marked_.push_back(clauses.variable());
    for (const explore::Unit& unit : units_) add_unit(unit);
  }

  [[nodiscard]] std::size_t units() const { return units_.size(); }
  [[nodiscard]] int marked(std::uint32_t place) const { return marked_[place]; }

  /// A literal that is true if and only if the formula is.
  int literal(const Formula& formula) {
    std::vector<int> parts;
    switch (formula.kind) {
      case Formula::Kind::at_least:
        return at_least(formula.node, formula.tokens);
      case Formula::Kind::enabled:
        return enabled(formula.node);
      case Formula::Kind::dead:
        for (std::uint32_t transition = 0; transition < net_.transitions(); ++transition)
          parts.push_back(-enabled(transition));
        return clauses_.all_of(parts);
      case Formula::Kind::negation:
        return -literal(formula.parts.front());
      case Formula::Kind::all:
        for (const Formula& part : formula.parts) parts.push_back(literal(part));
        return clauses_.all_of(parts);
      case Formula::Kind::any:
        for (const Formula& part : formula.parts) parts.push_back(-literal(part));
        return -clauses_.all_of(parts);
    }
    return clauses_.all_of({});
  }

 private:
  int at_least(std::uint32_t place, Tokens tokens) {
    if (tokens == 0) return clauses_.all_of({});
    if (tokens == 1) return marked(place);
    const auto [entry, added] = more_.try_emplace({place, tokens}, 0);
    if (!added) return entry->second;
    entry->second = clauses_.variable();
    clauses_.add({-entry->second, single_[place] != 0 ? -entry->second : marked(place)});
    return entry->second;
  }

  int enabled(std::uint32_t transition) {
    std::vector<int> needs;
    for (const Touch& touch : net_.of_transition(transition))
      if (touch.consumes > 0) needs.push_back(at_least(touch.node, touch.consumes));
    return clauses_.all_of(needs);
  }

  /// At most one place of the unit is marked: a chain of "one of the first n is".
  void add_unit(const explore::Unit& unit) {
    int before = 0;
    for (const std::uint32_t place : unit.places) {
      single_[place] = 1;
      const int now = clauses_.variable();
      clauses_.add({-marked(place), now});
      if (before != 0) {
        clauses_.add({-before, now});
        clauses_.add({-before, -marked(place)});
      }
      before = now;
    }
    if (!unit.always_one) return;
    std::vector<int> one;
    for (const std::uint32_t place : unit.places) one.push_back(marked(place));
    clauses_.add(one);
  }

  const PtNet& net_;
  Clauses& clauses_;
  std::vector<int> marked_;   // per place
  std::vector<char> single_;  // per place: in a unit
  std::vector<explore::Unit> units_;
  std::map<std::pair<std::uint32_t, Tokens>, int> more_;
};

std::vector<int> marks(const Statement& statement, const std::vector<std::uint32_t>& places) {
  std::vector<int> literals;
  for (const std::uint32_t place : places) literals.push_back(statement.marked(place));
  return literals;
}

}  // namespace

Exclusion exclude(const PtNet& net, const Formula& goal, const explore::Limits& limits, const Steps& steps) {
  explore::Watch watch(limits);
  Clauses clauses(watch);
  Statement statement(net, clauses);
  clauses.add({statement.literal(goal)});
  Exclusion result;
  result.units = statement.units();
  while (true) {
    const Clauses::Answer answer = clauses.solve(steps.conflicts);
    if (answer == Clauses::Answer::contradiction) {
      result.kind = Exclusion::Kind::excluded;
      return result;
    }
    if (answer == Clauses::Answer::gave_up) {
      result.why = watch.why().empty() ? "the solver met too many conflicts" : watch.why();
      return result;
    }
    if (result.traps >= steps.traps.value_or(result.traps + 1)) {
      result.why = "it takes more than " + std::to_string(result.traps) + " traps";
      return result;
    }
    PlaceSet empty(net.places(), 0);
    for (std::uint32_t place = 0; place < net.places(); ++place)
      empty[place] = clauses.is_true(statement.marked(place)) ? 0 : 1;
    const std::vector<std::uint32_t> trap = small_marked_trap(net, empty);
    if (trap.empty()) {
      result.kind = Exclusion::Kind::suspected;
      for (std::uint32_t place = 0; place < net.places(); ++place)
        if (empty[place] == 0) result.marked.push_back({place});
      return result;
    }
    ++result.traps;
    clauses.add(marks(statement, trap));
  }
}

}  // namespace tessera::siphons
