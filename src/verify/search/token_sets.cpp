#include "verify/search/token_sets.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "verify/communication/abstraction.hpp"

namespace tessera::verify {
namespace {

using net::Arc;
using net::PlaceId;

/// Moves of one token that need nothing else: whatever the facts are that a transition takes with it, there is one for
/// them.
class Moves {
 public:
  explicit Moves(const net::Net& net) : net_(net) {}

  void add(net::TransitionId id) {
    std::optional<PlaceId> from;
    std::vector<PlaceId> facts;
    for (const Arc& arc : net_.preset(id)) {
      if (net_[arc.place].fact.valid())
        facts.push_back(arc.place);
      else if (std::exchange(from, arc.place))
        return;
    }
    if (!from) return;
    std::ranges::sort(facts);
    for (const Arc& arc : net_.postset(id))
      if (!net_[arc.place].fact.valid()) found_[{*from, arc.place}].insert(facts);
  }

  [[nodiscard]] std::vector<std::pair<PlaceId, PlaceId>> certain() const {
    std::vector<std::pair<PlaceId, PlaceId>> all;
    for (const auto& [ends, facts] : found_) {
      std::set<net::FactId> taken;
      for (const std::vector<PlaceId>& places : facts)
        for (const PlaceId place : places) taken.insert(net_[place].fact);
      std::size_t combinations = 1;
      for (const net::FactId fact : taken) combinations *= net_.parts()[fact].values.size();
      const bool same = std::ranges::all_of(
          facts, [&](const std::vector<PlaceId>& places) { return places.size() == taken.size(); });
      if (same && facts.size() == combinations) all.push_back(ends);
    }
    return all;
  }

 private:
  const net::Net& net_;
  std::map<std::pair<PlaceId, PlaceId>, std::set<std::vector<PlaceId>>> found_;  // the facts that go with it
};

}  // namespace

TokenSets::TokenSets(const net::Net& net, const std::vector<net::Invariant>& invariants) {
  for (const net::Invariant& invariant : invariants) {
    const auto fits = [](const net::Invariant::Term& term) { return term.weight == 1; };
    const auto is_shared = [&](const net::Invariant::Term& term) {
      return net[term.place].fused() || net[term.place].fact.valid();
    };
    if (invariant.total != 1 || !std::ranges::all_of(invariant.terms, fits) ||
        std::ranges::none_of(invariant.terms, is_shared))
      continue;
    std::vector<PlaceId> places;
    std::uint32_t tokens = 0;
    for (const net::Invariant::Term& term : invariant.terms) {
      places.push_back(term.place);
      tokens += net[term.place].tokens;
    }
    if (tokens != 1) continue;
    for (const PlaceId place : places) with_[place].push_back(sets_.size());
    sets_.push_back(std::move(places));
  }
  std::set<std::size_t> changed;
  Moves moves(net);
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    std::map<std::size_t, std::int64_t> sums;
    const auto count = [&](std::span<const Arc> arcs, std::int64_t sign) {
      for (const Arc& arc : arcs)
        for (const std::size_t set : with(arc.place)) sums[set] += sign * arc.weight;
    };
    count(net.preset({index}), -1);
    count(net.postset({index}), 1);
    for (const auto& [set, sum] : sums)
      if (sum != 0) changed.insert(set);
    if (possible(net, {index})) moves.add({index});
  }
  for (auto& [place, sets] : with_)
    std::erase_if(sets, [&](std::size_t set) { return changed.contains(set); });
  for (const auto& [from, to] : moves.certain()) next_[from].push_back(to);
}

const std::vector<std::size_t>& TokenSets::with(PlaceId place) const {
  static const std::vector<std::size_t> none;
  const auto found = with_.find(place);
  return found == with_.end() ? none : found->second;
}

const std::vector<PlaceId>& TokenSets::next(PlaceId place) const {
  static const std::vector<PlaceId> none;
  const auto found = next_.find(place);
  return found == next_.end() ? none : found->second;
}

}  // namespace tessera::verify
