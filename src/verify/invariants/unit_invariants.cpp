#include "verify/invariants/unit_invariants.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace tessera::verify {

using explore::Formula;
using net::PlaceId;

UnitInvariants::UnitInvariants(const net::Net& net, const std::vector<net::Invariant>& invariants)
    : of_(net.places().size()) {
  for (const net::Invariant& invariant : invariants) {
    const bool is_unit =
        invariant.total >= 0 && invariant.total <= 1 &&
        std::ranges::all_of(invariant.terms, [](const auto& term) { return term.weight > 0; });
    if (!is_unit) continue;
    const auto number = static_cast<std::uint32_t>(units_.size());
    units_.push_back({invariant.total, 0});
    for (const auto& term : invariant.terms) {
      std::vector<std::uint32_t>& units = of_[term.place.value];
      if (!units.empty() && units.back() == number) continue;
      units.push_back(number);
      ++units_.back().places;
    }
  }
}

/// A tableau: every branch of the formula's truth is led to a contradiction with some invariant.
class Refutation {
 public:
  explicit Refutation(const UnitInvariants& invariants) : invariants_(invariants) {}

  bool of(const Formula& formula) { return closes({}, {{&formula, true}}); }

 private:
  struct Wanted {
    const Formula* formula;
    bool positive;
  };
  struct Branch {
    std::map<PlaceId, bool> marked;                   // and those that are not
    std::map<std::uint32_t, PlaceId> taken;           // per unit its marked place
    std::map<std::uint32_t, std::uint32_t> unmarked;  // per unit how many of its places are not
  };

  /// Whether the assumption contradicts the branch or an invariant.
  bool contradicts(Branch& branch, PlaceId place, bool marked) const {
    const auto [entry, added] = branch.marked.emplace(place, marked);
    if (!added) return entry->second != marked;
    for (const std::uint32_t unit : invariants_.of(place)) {
      const UnitInvariants::Unit& sum = invariants_.units_[unit];
      if (marked && (sum.total == 0 || !branch.taken.emplace(unit, place).second)) return true;
      if (!marked && ++branch.unmarked[unit] == sum.places && sum.total == 1) return true;
    }
    return false;
  }

  bool contradicts(Branch& branch, const Formula& token, bool positive) const {
    const PlaceId place{token.node};
    if (token.tokens == 0) return !positive;
    if (token.tokens == 1) return contradicts(branch, place, positive);
    return positive && (!invariants_.of(place).empty() || contradicts(branch, place, true));
  }

  // By value: each branch goes its own way.
  bool closes(Branch branch, std::vector<Wanted> open) {
    while (!open.empty()) {
      const auto [formula, positive] = open.back();
      open.pop_back();
      switch (formula->kind) {
        case Formula::Kind::at_least:
          if (contradicts(branch, *formula, positive)) return true;
          continue;
        case Formula::Kind::negation:
          open.push_back({&formula->parts.front(), !positive});
          continue;
        case Formula::Kind::all:
        case Formula::Kind::any:
          break;
        case Formula::Kind::enabled:
        case Formula::Kind::dead:
          return false;
      }
      const bool together = (formula->kind == Formula::Kind::all) == positive;
      if (!together) return closes_each(branch, open, *formula, positive);
      for (const Formula& part : formula->parts) open.push_back({&part, positive});
    }
    return false;
  }

  bool closes_each(const Branch& branch, const std::vector<Wanted>& open, const Formula& formula,
                   bool positive) {
    return std::ranges::all_of(formula.parts, [&](const Formula& part) {
      if (++branches_ > most_branches) return false;
      std::vector<Wanted> rest = open;
      rest.push_back({&part, positive});
      return closes(branch, std::move(rest));
    });
  }

  static constexpr std::size_t most_branches = 20'000;
  const UnitInvariants& invariants_;
  std::size_t branches_ = 0;
};

bool UnitInvariants::exclude(const Formula& formula) const { return Refutation(*this).of(formula); }

}  // namespace tessera::verify
