#include "explore/stubborn.hpp"

#include <limits>

namespace tessera::explore {

StubbornSets::StubbornSets(const PtNet& net)
    : net_(net), is_enabled_(net.transitions(), 0), member_(net.transitions(), 0) {}

std::span<const std::uint32_t> StubbornSets::choose(std::span<const Tokens> marking) {
  enabled_.clear();
  for (std::uint32_t transition = 0; transition < net_.transitions(); ++transition) {
    const bool enabled = net_.enabled(transition, marking);
    is_enabled_[transition] = enabled ? 1 : 0;
    if (enabled) enabled_.push_back(transition);
  }
  best_ = enabled_;
  // Every seed gives a stubborn set. Trying more seeds pays as long as it costs less than a few markings.
  std::size_t effort_left = 4 * std::size_t{net_.transitions()} + 64;
  for (const std::uint32_t seed : enabled_) {
    if (best_.size() <= 1) break;
    close(seed, marking, best_.size());
    if (chosen_.size() < best_.size()) best_.swap(chosen_);
    if (set_.size() >= effort_left) break;
    effort_left -= set_.size();
  }
  return best_;
}

/// Computes the closure of {seed} into set_, and its enabled members (at most give_up_at) into chosen_.
void StubbornSets::close(std::uint32_t seed, std::span<const Tokens> marking, std::size_t give_up_at) {
  if (++set_number_ == std::numeric_limits<std::uint32_t>::max()) {
    member_.assign(member_.size(), 0);
    set_number_ = 1;
  }
  set_.clear();
  chosen_.clear();
  add(seed);
  for (std::size_t at = 0; at < set_.size() && chosen_.size() < give_up_at; ++at) {
    if (is_enabled_[set_[at]] != 0)
      add_rivals(set_[at]);
    else
      add_suppliers(set_[at], marking);
  }
}

void StubbornSets::add(std::uint32_t transition) {
  if (member_[transition] == set_number_) return;
  member_[transition] = set_number_;
  set_.push_back(transition);
  if (is_enabled_[transition] != 0) chosen_.push_back(transition);
}

/// Adds the transitions that it could disable, or that could disable it.
void StubbornSets::add_rivals(std::uint32_t transition) {
  for (const Touch& own : net_.of_transition(transition)) {
    if (own.consumes == 0) continue;
    for (const Touch& other : net_.of_place(own.node))
      if (other.consumes > 0 && (own.effect() < 0 || other.effect() < 0)) add(other.node);
  }
}

/// Adds the transitions without which it stays disabled.
void StubbornSets::add_suppliers(std::uint32_t transition, std::span<const Tokens> marking) {
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  std::uint32_t scapegoat = 0;
  for (const Touch& touch : net_.of_transition(transition)) {
    if (marking[touch.node] >= touch.consumes) continue;
    const std::size_t missing = suppliers_missing(touch.node);
    if (missing >= fewest) continue;
    fewest = missing;
    scapegoat = touch.node;
  }
  for (const Touch& touch : net_.of_place(scapegoat))
    if (touch.effect() > 0) add(touch.node);
}

/// Enabled suppliers count more, because they make the set expensive.
std::size_t StubbornSets::suppliers_missing(std::uint32_t place) const {
  std::size_t cost = 0;
  for (const Touch& touch : net_.of_place(place))
    if (touch.effect() > 0 && member_[touch.node] != set_number_)
      cost += is_enabled_[touch.node] != 0 ? 16 : 1;
  return cost;
}

}  // namespace tessera::explore
