#include "reduce/naive_explorer.hpp"

#include <algorithm>

namespace tessera::test {

std::optional<Tokens> fire(const net::Net& net, const Tokens& marking, net::TransitionId transition) {
  Tokens next = marking;
  for (const net::Arc& arc : net.preset(transition)) {
    if (next[arc.place.value] < arc.weight) return std::nullopt;
    next[arc.place.value] -= arc.weight;
  }
  for (const net::Arc& arc : net.postset(transition)) next[arc.place.value] += arc.weight;
  return next;
}

Tokens initial(const net::Net& net) {
  Tokens marking;
  for (const net::Place& place : net.places()) marking.push_back(place.tokens);
  return marking;
}

std::uint32_t NaiveExplorer::number(const Tokens& marking, std::uint32_t from, net::TransitionId by) {
  const auto [entry, added] = numbers_.emplace(marking, static_cast<std::uint32_t>(markings_.size()));
  if (added) {
    markings_.push_back(marking);
    firings_.emplace_back();
    reached_by_.emplace_back(from, by);
  }
  return entry->second;
}

std::optional<NaiveExplorer> NaiveExplorer::explore(const net::Net& net, std::size_t most_markings) {
  NaiveExplorer all;
  all.number(initial(net), 0, {});
  for (std::uint32_t at = 0; at < all.markings_.size(); ++at) {
    if (all.markings_.size() > most_markings) return std::nullopt;
    for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
      const net::TransitionId id{index};
      if (net[id].condition.truth == net::Condition::Truth::never) continue;
      if (const auto next = fire(net, all.markings_[at], id)) {
        const std::uint32_t to = all.number(*next, at, id);
        all.firings_[at].push_back({id, to});
      }
    }
  }
  return all;
}

bool NaiveExplorer::safe() const {
  return std::ranges::all_of(markings_, [](const Tokens& marking) {
    return std::ranges::all_of(marking, [](std::uint32_t tokens) { return tokens <= 1; });
  });
}

std::optional<std::uint32_t> NaiveExplorer::deadlock() const {
  for (std::uint32_t index = 0; index < firings_.size(); ++index)
    if (firings_[index].empty()) return index;
  return std::nullopt;
}

bool NaiveExplorer::can_always_fire(const std::set<net::TransitionId>& transitions) const {
  std::vector<bool> can(markings_.size(), false);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::uint32_t index = 0; index < firings_.size(); ++index) {
      if (can[index]) continue;
      can[index] = std::ranges::any_of(firings_[index], [&](const Firing& firing) {
        return can[firing.to] || transitions.contains(firing.transition);
      });
      changed = changed || can[index];
    }
  }
  return std::ranges::all_of(can, [](bool here) { return here; });
}

std::set<Tokens> NaiveExplorer::reached(const std::vector<net::PlaceId>& places) const {
  std::set<Tokens> all;
  for (const Tokens& marking : markings_) {
    Tokens seen;
    for (const net::PlaceId place : places) seen.push_back(marking[place.value]);
    all.insert(seen);
  }
  return all;
}

std::vector<net::TransitionId> NaiveExplorer::trace_to(std::uint32_t marking) const {
  std::vector<net::TransitionId> trace;
  for (; marking != 0; marking = reached_by_[marking].first) trace.push_back(reached_by_[marking].second);
  std::ranges::reverse(trace);
  return trace;
}

}  // namespace tessera::test
