#include "verify/counterexample/aftermath.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "verify/communication/abstraction.hpp"

namespace tessera::verify {
namespace {

using net::Arc;
using net::TransitionId;

/// The subsystems and those that use a channel with one of them.
std::set<std::uint32_t> that_exchange(const net::Net& net, std::set<std::uint32_t> subsystems) {
  std::map<std::uint32_t, std::set<std::uint32_t>> users;  // per place of a channel
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    for (const auto arcs : {net.preset({index}), net.postset({index})})
      for (const Arc& arc : arcs)
        if (net[arc.place].fused()) users[arc.place.value].insert(net.transitions()[index].subsystem);
  std::map<std::uint32_t, std::set<std::uint32_t>> peers;
  for (const auto& [place, all] : users)
    for (const std::uint32_t one : all) peers[one].insert(all.begin(), all.end());
  std::vector<std::uint32_t> open(subsystems.begin(), subsystems.end());
  while (!open.empty()) {
    const std::uint32_t one = open.back();
    open.pop_back();
    for (const std::uint32_t peer : peers[one])
      if (subsystems.insert(peer).second) open.push_back(peer);
  }
  return subsystems;
}

}  // namespace

std::optional<Aftermath> Aftermath::of(const net::Net& net, const Run& run,
                                       const std::set<std::uint32_t>& subsystems, std::size_t most) {
  Aftermath all(net);
  all.choose(that_exchange(net, subsystems));
  all.begin_after(run);
  if (!all.explored(most)) return std::nullopt;
  return all;
}

/// The transitions of the subsystems, and those of the upper layers that start them.
void Aftermath::choose(const std::set<std::uint32_t>& subsystems) {
  std::vector<bool> wanted(net_->places().size(), false), chosen(net_->transitions().size(), false);
  for (std::uint32_t place = 0; place < wanted.size(); ++place)
    wanted[place] = subsystems.contains(net_->places()[place].subsystem) && !net_->places()[place].fused();
  for (bool grew = true; grew;) {
    grew = false;
    for (std::uint32_t index = 0; index < chosen.size(); ++index) {
      const TransitionId id{index};
      if (chosen[index] || !possible(*net_, id)) continue;
      const bool starts =
          (*net_)[id].subsystem == net::no_subsystem &&
          std::ranges::any_of(net_->postset(id), [&](const Arc& arc) { return wanted[arc.place.value]; });
      if (!starts && !subsystems.contains((*net_)[id].subsystem)) continue;
      chosen[index] = grew = true;
      transitions_.push_back(id);
      if (starts)
        for (const Arc& arc : net_->preset(id)) wanted[arc.place.value] = true;
    }
  }
  std::uint32_t next = 0;
  for (const TransitionId id : transitions_)
    for (const auto arcs : {net_->preset(id), net_->postset(id)})
      for (const Arc& arc : arcs)
        if (std::uint32_t& local = local_[arc.place.value]; local == UINT32_MAX) local = next++;
}

void Aftermath::begin_after(const Run& run) {
  for (const net::Place& place : net_->places()) at_start_.push_back(place.tokens);
  for (const TransitionId id : run) {
    for (const Arc& arc : net_->preset(id)) at_start_[arc.place.value] -= arc.weight;
    for (const Arc& arc : net_->postset(id)) at_start_[arc.place.value] += arc.weight;
  }
  std::string marking(local_.size(), '\0');
  std::size_t used = 0;
  for (std::uint32_t place = 0; place < local_.size(); ++place)
    if (local_[place] != UINT32_MAX) {
      marking[local_[place]] = static_cast<char>(at_start_[place]);
      ++used;
    }
  marking.resize(used);
  static_cast<void>(number(marking));
}

Aftermath::Number Aftermath::number(const std::string& marking) {
  const auto [entry, added] = numbers_.emplace(marking, static_cast<Number>(markings_.size()));
  if (added) {
    markings_.push_back(marking);
    edges_.emplace_back();
  }
  return entry->second;
}

bool Aftermath::explored(std::size_t most) {
  constexpr std::size_t most_work = 10'000'000;  // of a large fleet each marking is much work
  most = std::min(most, most_work / std::max<std::size_t>(transitions_.size(), 1));
  for (Number at = 0; at < markings_.size(); ++at) {
    if (markings_.size() > most) return false;
    const std::string marking = markings_[at];
    for (const TransitionId id : transitions_) {
      const auto has = [&](const Arc& arc) {
        return static_cast<unsigned char>(marking[local_[arc.place.value]]) >= arc.weight;
      };
      if (!std::ranges::all_of(net_->preset(id), has)) continue;
      std::string next = marking;
      const auto change = [&](const Arc& arc, int sign) {
        char& tokens = next[local_[arc.place.value]];
        tokens = static_cast<char>(tokens + sign * static_cast<int>(arc.weight));
      };
      for (const Arc& arc : net_->preset(id)) change(arc, -1);
      for (const Arc& arc : net_->postset(id)) change(arc, 1);
      // A net that is not safe could grow for ever.
      if (std::ranges::any_of(next, [](char tokens) { return static_cast<unsigned char>(tokens) > 100; }))
        return false;
      const Number to = number(next);
      edges_[at].push_back({id, to});
    }
  }
  return true;
}

Aftermath::Markings Aftermath::can_reach(Markings goal) const {
  std::vector<std::vector<Number>> before(size());
  for (Number at = 0; at < size(); ++at)
    for (const Edge& edge : edges_[at]) before[edge.to].push_back(at);
  std::vector<Number> open;
  for (Number at = 0; at < size(); ++at)
    if (goal[at]) open.push_back(at);
  while (!open.empty()) {
    const Number at = open.back();
    open.pop_back();
    for (const Number one : before[at]) {
      if (goal[one]) continue;
      goal[one] = true;
      open.push_back(one);
    }
  }
  return goal;
}

Aftermath::Markings Aftermath::can_fire(const std::vector<TransitionId>& any_of) const {
  const std::set<TransitionId> wanted(any_of.begin(), any_of.end());
  Markings now(size(), false);
  for (Number at = 0; at < size(); ++at)
    now[at] =
        std::ranges::any_of(edges_[at], [&](const Edge& edge) { return wanted.contains(edge.transition); });
  return can_reach(std::move(now));
}

Aftermath::Markings Aftermath::reachable_from(Number from) const {
  Markings reached(size(), false);
  std::vector<Number> open{from};
  reached[from] = true;
  while (!open.empty()) {
    const Number at = open.back();
    open.pop_back();
    for (const Edge& edge : edges_[at]) {
      if (reached[edge.to]) continue;
      reached[edge.to] = true;
      open.push_back(edge.to);
    }
  }
  return reached;
}

std::optional<Aftermath::Way> Aftermath::way(Number from, const Markings& goal) const {
  constexpr Number nowhere = UINT32_MAX;
  std::vector<Number> open{from}, before(size(), nowhere);
  std::vector<TransitionId> by(size());
  before[from] = from;
  for (std::size_t next = 0; next < open.size(); ++next) {
    const Number at = open[next];
    if (goal[at]) {
      Way way{{}, at};
      for (Number step = at; step != from; step = before[step]) way.run.push_back(by[step]);
      std::ranges::reverse(way.run);
      return way;
    }
    for (const Edge& edge : edges_[at]) {
      if (before[edge.to] != nowhere) continue;
      before[edge.to] = at;
      by[edge.to] = edge.transition;
      open.push_back(edge.to);
    }
  }
  return std::nullopt;
}

std::vector<std::uint32_t> Aftermath::tokens(Number marking) const {
  std::vector<std::uint32_t> all = at_start_;
  for (std::uint32_t place = 0; place < all.size(); ++place)
    if (local_[place] != UINT32_MAX)
      all[place] = static_cast<unsigned char>(markings_[marking][local_[place]]);
  return all;
}

}  // namespace tessera::verify
