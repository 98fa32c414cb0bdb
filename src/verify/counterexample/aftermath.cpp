#include "verify/counterexample/aftermath.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "verify/communication/abstraction.hpp"

namespace tessera::verify {
namespace {

using net::Arc;
using net::PlaceId;
using net::TransitionId;

/// The subsystems and those that use a channel with one of them.
std::set<net::SubsystemId> that_exchange(const net::Net& net, std::set<net::SubsystemId> subsystems) {
  std::map<PlaceId, std::set<net::SubsystemId>> users;  // per place of a channel
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index)
    for (const auto arcs : {net.preset({index}), net.postset({index})})
      for (const Arc& arc : arcs)
        if (net[arc.place].fused()) users[arc.place].insert(net.transitions()[index].subsystem);
  std::map<net::SubsystemId, std::set<net::SubsystemId>> peers;
  for (const auto& [place, all] : users)
    for (const net::SubsystemId one : all) peers[one].insert(all.begin(), all.end());
  std::vector<net::SubsystemId> open(subsystems.begin(), subsystems.end());
  while (!open.empty()) {
    const net::SubsystemId one = open.back();
    open.pop_back();
    for (const net::SubsystemId peer : peers[one])
      if (subsystems.insert(peer).second) open.push_back(peer);
  }
  return subsystems;
}

/// One byte per place: markings are many.
std::string packed(const net::Marking& marking) {
  std::string bytes;
  for (const std::uint32_t tokens : marking) bytes += static_cast<char>(tokens);
  return bytes;
}

net::Marking unpacked(const std::string& bytes) {
  net::Marking marking;
  for (const char tokens : bytes) marking.push_back(static_cast<unsigned char>(tokens));
  return marking;
}

}  // namespace

std::optional<Aftermath> Aftermath::of(const net::Net& net, const Run& run,
                                       const std::set<net::SubsystemId>& subsystems, std::size_t most,
                                       const explore::Budget& budget) {
  Aftermath all(net);
  all.choose(that_exchange(net, subsystems));
  all.begin_after(run);
  if (!all.explored(most, budget)) return std::nullopt;
  return all;
}

/// The transitions of the subsystems, and those of the upper layers that start them.
void Aftermath::choose(const std::set<net::SubsystemId>& subsystems) {
  std::vector<bool> wanted(net_->places().size(), false), chosen(net_->transitions().size(), false);
  for (std::uint32_t place = 0; place < wanted.size(); ++place)
    wanted[place] = subsystems.contains(net_->places()[place].subsystem) && !net_->places()[place].fused();
  for (bool grew = true; grew;) {
    grew = false;
    for (std::uint32_t index = 0; index < chosen.size(); ++index) {
      const TransitionId id{index};
      if (chosen[index] || !possible(*net_, id)) continue;
      const bool starts =
          !(*net_)[id].subsystem.valid() &&
          std::ranges::any_of(net_->postset(id), [&](const Arc& arc) { return wanted[arc.place.value]; });
      if (!starts && !subsystems.contains((*net_)[id].subsystem)) continue;
      chosen[index] = grew = true;
      transitions_.push_back(id);
      if (starts)
        for (const Arc& arc : net_->preset(id)) wanted[arc.place.value] = true;
    }
  }
  for (const TransitionId id : transitions_)
    part_.add(net::Transition{}, in_part(net_->preset(id)), in_part(net_->postset(id)));
}

/// The same arcs in the part of the net that is played.
std::vector<Arc> Aftermath::in_part(std::span<const Arc> arcs) {
  std::vector<Arc> own;
  for (const Arc& arc : arcs) {
    PlaceId& place = local_[arc.place.value];
    if (!place.valid()) place = part_.add(net::Place{});
    own.push_back({place, arc.weight});
  }
  return own;
}

void Aftermath::begin_after(const Run& run) {
  at_start_ = net::marking_after(*net_, run);
  net::Marking marking(part_.places().size());
  for (std::uint32_t place = 0; place < local_.size(); ++place)
    if (local_[place].valid()) marking[local_[place].value] = at_start_[place];
  static_cast<void>(number(packed(marking)));
}

Aftermath::Number Aftermath::number(const std::string& marking) {
  const auto [entry, added] = numbers_.emplace(marking, static_cast<Number>(markings_.size()));
  if (added) {
    markings_.push_back(marking);
    edges_.emplace_back();
  }
  return entry->second;
}

bool Aftermath::explored(std::size_t most, const explore::Budget& budget) {
  constexpr std::size_t most_work = 10'000'000;  // of a large fleet each marking is much work
  std::size_t bytes_left = std::size_t{1} << 28U;
  most = std::min(most, most_work / std::max<std::size_t>(transitions_.size(), 1));
  for (Number at = 0; at < markings_.size(); ++at) {
    if (markings_.size() > most) return false;
    budget.check();
    const net::Marking marking = unpacked(markings_[at]);
    for (std::uint32_t index = 0; index < transitions_.size(); ++index) {
      if (!net::enabled(part_, {index}, marking)) continue;
      net::Marking next = marking;
      net::fire(part_, {index}, next);
      // A net that is not safe could grow for ever.
      if (std::ranges::any_of(next, [](std::uint32_t tokens) { return tokens > 100; })) return false;
      const std::size_t bytes = 2 * next.size();  // it is kept twice
      if (bytes > bytes_left) return false;
      const std::size_t known = markings_.size();
      const Number to = number(packed(next));
      if (to == known) bytes_left -= bytes;
      edges_[at].push_back({transitions_[index], to});
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
  std::vector<Number> open{from};
  std::vector<std::optional<Number>> before(size());
  std::vector<TransitionId> by(size());
  before[from] = from;
  for (std::size_t next = 0; next < open.size(); ++next) {
    const Number at = open[next];
    if (goal[at]) {
      Way way{{}, at};
      for (Number step = at; step != from; step = before[step].value()) way.run.push_back(by[step]);
      std::ranges::reverse(way.run);
      return way;
    }
    for (const Edge& edge : edges_[at]) {
      if (before[edge.to]) continue;
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
    if (local_[place].valid())
      all[place] = static_cast<unsigned char>(markings_[marking][local_[place].value]);
  return all;
}

}  // namespace tessera::verify
