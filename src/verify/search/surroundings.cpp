#include "verify/search/surroundings.hpp"

#include <algorithm>
#include <span>

#include "verify/communication/abstraction.hpp"

namespace tessera::verify {

using net::Arc;
using net::PlaceId;

Surroundings::Surroundings(const net::Net& net)
    : net_(net),
      transitions_(net.parts().subsystems.size()),
      users_(net.places().size()),
      controlled_by_(net.places().size()),
      started_(net.places().size(), false) {
  for (std::uint32_t index = 0; index < net.transitions().size(); ++index) {
    const net::TransitionId id{index};
    const net::SubsystemId subsystem = net[id].subsystem;
    if (subsystem.value < transitions_.size() && possible(net, id))
      transitions_[subsystem.value].push_back(id);
    for (const auto arcs : {net.preset(id), net.postset(id)})
      for (const Arc& arc : arcs) {
        if (!net[arc.place].fused()) continue;
        users_[arc.place.value].insert(subsystem);
        if (subsystem.valid()) members_[net[arc.place].channel].insert(subsystem);
      }
    const auto is_in_subsystem = [&](const Arc& arc) { return net[arc.place].subsystem.valid(); };
    if (subsystem.valid() || std::ranges::any_of(net.preset(id), is_in_subsystem)) continue;
    for (const Arc& arc : net.postset(id))
      if (net[arc.place].subsystem.valid() && !net[arc.place].fused()) started_[arc.place.value] = true;
  }
  for (std::uint32_t index = 0; index < net.places().size(); ++index) {
    const net::Place& place = net.places()[index];
    if (place.fact.valid()) continue;
    if (!place.fused()) controlled_by_[index] = place.subsystem;
    if (place.fused() && users_[index].size() == 1) controlled_by_[index] = *users_[index].begin();
  }
}

std::set<net::SubsystemId> Surroundings::with_peers(net::SubsystemId subsystem) const {
  std::set<net::SubsystemId> all{subsystem};
  for (const net::TransitionId id : transitions_[subsystem.value])
    for (const auto arcs : {net_.preset(id), net_.postset(id)})
      for (const Arc& arc : arcs)
        if (net_[arc.place].fused()) {
          const std::set<net::SubsystemId>& members = members_.at(net_[arc.place].channel);
          all.insert(members.begin(), members.end());
        }
  return all;
}

bool Surroundings::stays(PlaceId place, const std::set<net::SubsystemId>& subsystems) const {
  if (!net_[place].fused()) return subsystems.contains(net_[place].subsystem);
  return std::ranges::includes(subsystems, users_[place.value]);
}

const std::set<net::SubsystemId>& Surroundings::members(net::ChannelId channel) const {
  static const std::set<net::SubsystemId> none;
  const auto found = members_.find(channel);
  return found == members_.end() ? none : found->second;
}

bool Surroundings::is_between(net::ChannelId channel, const std::set<net::SubsystemId>& subsystems) const {
  const auto members = members_.find(channel);
  return members != members_.end() && std::ranges::includes(subsystems, members->second);
}

Surroundings::Part Surroundings::around(net::SubsystemId subsystem) const {
  const std::set<net::SubsystemId> subsystems = with_peers(subsystem);
  Part part;
  const auto left = [&](std::span<const Arc> arcs) {
    std::vector<Arc> there;
    for (const Arc& arc : arcs) {
      if (!stays(arc.place, subsystems)) continue;
      const auto [entry, added] = part.place_of.try_emplace(arc.place);
      if (added) {
        net::Place place;
        place.tokens = std::max(net_[arc.place].tokens, started_[arc.place.value] ? 1U : 0U);
        entry->second = part.net.add(std::move(place));
      }
      there.push_back({entry->second, arc.weight});
    }
    return there;
  };
  for (const net::SubsystemId one : subsystems)
    for (const net::TransitionId id : transitions_[one.value]) {
      const std::vector<Arc> from = left(net_.preset(id)), to = left(net_.postset(id));
      if (!from.empty() || !to.empty()) part.net.add(net::Transition{}, from, to);
    }
  return part;
}

}  // namespace tessera::verify
