#include "verify/invariants/place_invariants.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

namespace tessera::verify {
namespace {

using net::Invariant;
using net::PlaceId;

struct Membership {
  std::uint32_t invariant = 0;
  std::int32_t weight = 0;
};

/// For each place, the invariants that count it.
class Memberships {
 public:
  Memberships(std::size_t places, const std::vector<Invariant>& invariants) : starts_(places + 1, 0) {
    for (const Invariant& invariant : invariants)
      for (const Invariant::Term& term : invariant.terms) ++starts_[term.place.value + 1];
    for (std::size_t place = 0; place < places; ++place) starts_[place + 1] += starts_[place];
    all_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::uint32_t index = 0; index < invariants.size(); ++index)
      for (const Invariant::Term& term : invariants[index].terms)
        all_[next[term.place.value]++] = {index, term.weight};
  }

  [[nodiscard]] std::span<const Membership> of(PlaceId place) const {
    return std::span(all_).subspan(starts_[place.value], starts_[place.value + 1] - starts_[place.value]);
  }

 private:
  std::vector<std::size_t> starts_;
  std::vector<Membership> all_;
};

/// The change that one firing makes to each invariant it touches.
class Change {
 public:
  explicit Change(std::size_t invariants) : amount_(invariants, 0) {}

  void count(std::span<const net::Arc> arcs, const Memberships& memberships, std::int64_t sign) {
    for (const net::Arc& arc : arcs)
      for (const Membership& member : memberships.of(arc.place)) {
        amount_[member.invariant] += sign * member.weight * std::int64_t{arc.weight};
        touched_.push_back(member.invariant);
      }
  }

  /// Calls visit(invariant, amount) once for each changed invariant and forgets.
  template <class Visit>
  void take(Visit visit) {
    for (const std::uint32_t invariant : touched_)
      if (const std::int64_t amount = std::exchange(amount_[invariant], 0); amount != 0)
        visit(invariant, amount);
    touched_.clear();
  }

 private:
  std::vector<std::int64_t> amount_;
  std::vector<std::uint32_t> touched_;
};

std::string in_quotes(const std::string& name) { return "'" + name + "'"; }

class Bounds {
 public:
  Bounds(const net::Net& net, const std::vector<Invariant>& invariants)
      : invariants_(invariants),
        memberships_(net.places().size(), invariants),
        bounded_(net.places().size(), false),
        stands_for_(net.places().size()),
        counted_(net.places().size(), false),
        hits_(invariants.size(), 0) {}

  std::vector<PlaceId> unbounded() {
    for (const Invariant& invariant : invariants_) unit_.push_back(is_unit(invariant));
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t index = 0; index < invariants_.size(); ++index) {
      if (unit_[index])
        mark(invariants_[index]);
      else if (invariants_[index].total == 0)
        waiting.push_back(index);
    }
    // One signed invariant may rest on another.
    for (bool progress = true; progress;)
      progress = std::erase_if(waiting, [&](std::uint32_t index) { return bounds_positive(index); }) > 0;

    std::vector<PlaceId> rest;
    for (std::uint32_t place = 0; place < bounded_.size(); ++place)
      if (!bounded_[place]) rest.push_back(PlaceId{place});
    return rest;
  }

 private:
  static bool is_unit(const Invariant& invariant) {
    return invariant.total <= 1 &&
           std::ranges::all_of(invariant.terms, [](const Invariant::Term& term) { return term.weight >= 1; });
  }

  void mark(const Invariant& invariant) {
    for (const Invariant::Term& term : invariant.terms) bounded_[term.place.value] = true;
  }

  bool bounds_positive(std::uint32_t index) {
    const Invariant& invariant = invariants_[index];
    std::vector<PlaceId> negative;
    for (const Invariant::Term& term : invariant.terms) {
      if (term.weight < -1) return false;
      if (term.weight == -1) negative.push_back(term.place);
    }
    if (!within_one_unit(negative)) {
      const std::optional<std::vector<PlaceId>> replaced = replace(negative);
      if (!replaced || !within_one_unit(*replaced)) return false;
    }
    for (const Invariant::Term& term : invariant.terms) {
      if (term.weight < 1) continue;
      bounded_[term.place.value] = true;
      if (!stands_for_[term.place.value]) stands_for_[term.place.value] = index;
    }
    return true;
  }

  /// Is there a unit invariant that counts all of these (different) places?
  bool within_one_unit(const std::vector<PlaceId>& places) {
    bool found = places.empty();
    for (const PlaceId place : places)
      for (const Membership& member : memberships_.of(place))
        if (unit_[member.invariant] && ++hits_[member.invariant] == places.size()) found = true;
    for (const PlaceId place : places)
      for (const Membership& member : memberships_.of(place)) hits_[member.invariant] = 0;
    return found;
  }

  /// Places that together hold at least as many tokens: each place that is positive in a bounded signed
  /// invariant becomes the negative ones of that, once per invariant. nullopt if a place would count twice.
  std::optional<std::vector<PlaceId>> replace(const std::vector<PlaceId>& places) {
    std::vector<PlaceId> replaced;
    std::vector<std::uint32_t> used;
    for (const PlaceId place : places) {
      const std::optional<std::uint32_t> index = stands_for_[place.value];
      if (!index)
        replaced.push_back(place);
      else
        used.push_back(*index);
    }
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const std::uint32_t index : used)
      for (const Invariant::Term& term : invariants_[index].terms)
        if (term.weight < 0) replaced.push_back(term.place);

    bool twice = false;
    for (const PlaceId place : replaced) {
      twice = twice || counted_[place.value];
      counted_[place.value] = true;
    }
    for (const PlaceId place : replaced) counted_[place.value] = false;
    if (twice) return std::nullopt;
    return replaced;
  }

  const std::vector<Invariant>& invariants_;
  Memberships memberships_;
  std::vector<bool> unit_;     // per invariant
  std::vector<bool> bounded_;  // per place
  std::vector<std::optional<std::uint32_t>>
      stands_for_;                 // per place: bounded signed invariant that counts it
  std::vector<bool> counted_;      // per place, scratch
  std::vector<std::size_t> hits_;  // per invariant, scratch
};

}  // namespace

std::vector<std::string> wrong_invariants(const net::Net& net, const std::vector<Invariant>& invariants) {
  std::vector<std::string> mistakes;
  for (const Invariant& invariant : invariants) {
    std::int64_t start = 0;
    for (const Invariant::Term& term : invariant.terms)
      start += std::int64_t{term.weight} * net[term.place].tokens;
    if (start != invariant.total)
      mistakes.push_back("invariant " + in_quotes(invariant.name) + " starts with " + std::to_string(start) +
                         ", not with " + std::to_string(invariant.total));
  }
  const Memberships memberships(net.places().size(), invariants);
  Change change(invariants.size());
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId transition{index};
    change.count(net.preset(transition), memberships, -1);
    change.count(net.postset(transition), memberships, 1);
    change.take([&](std::uint32_t invariant, std::int64_t amount) {
      mistakes.push_back("transition " + in_quotes(net[transition].name) + " changes invariant " +
                         in_quotes(invariants[invariant].name) + " by " + std::to_string(amount));
    });
  }
  return mistakes;
}

std::vector<PlaceId> unbounded_places(const net::Net& net, const std::vector<Invariant>& invariants) {
  return Bounds(net, invariants).unbounded();
}

}  // namespace tessera::verify
