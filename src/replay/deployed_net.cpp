#include "replay/deployed_net.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <tuple>

namespace tessera::replay {

using net::Arc;
using net::ChannelId;
using net::PlaceId;
using net::TransitionId;

namespace {

bool holds_role(const net::Net& net, std::span<const Arc> arcs, PlaceRole role) {
  return std::ranges::any_of(arcs, [&](const Arc& arc) { return net[arc.place].role == role; });
}

}  // namespace

DeployedNet::DeployedNet(const net::Net& net, const ProcessMap& processes)
    : net_(net),
      process_count_(processes.names.size()),
      channels_(net.parts().channels.size()),
      transitions_(net.transitions().size()) {
  find_channels(processes);
  find_transitions(processes);
  join_groups();
  find_owners(processes);
}

void DeployedNet::find_channels(const ProcessMap& processes) {
  for (const net::Parts::Block& block : net_.parts().blocks) {
    Channel& channel = channels_[block.channel.value];
    const ProcessId process = processes.of_agents[net_.parts()[block.subsystem].agent];
    (block.sends ? channel.sender : channel.receiver) = block.subsystem;
    (block.sends ? channel.sending : channel.receiving) = process;
  }
  bits_.assign(net_.places().size(), 0);
  for (std::uint32_t index = 0; index < net_.places().size(); ++index) {
    const net::Place& place = net_.places()[index];
    if (!place.fused()) continue;
    Channel& channel = channels_[place.channel.value];
    channel.networked = channel.networked || is_networked(place.role);
    channel.exchange = channel.exchange || place.role == PlaceRole::sent_memory;
    bits_[index] = 1U << channel.places.size();
    channel.places.push_back({index});
  }
}

DeployedNet::Move DeployedNet::move_of(TransitionId id) const {
  Move move;
  for (const Arc& arc : net_.preset(id)) move.takes |= bits_[arc.place.value];
  for (const Arc& arc : net_.postset(id)) move.gives |= bits_[arc.place.value];
  return move;
}

ChannelEffect DeployedNet::effect_of(TransitionId id) const {
  const auto takes = [&](PlaceRole role) { return holds_role(net_, net_.preset(id), role); };
  const auto gives = [&](PlaceRole role) { return holds_role(net_, net_.postset(id), role); };
  using Role = PlaceRole;
  if (takes(Role::sent_memory)) return ChannelEffect::begins_write;
  if (gives(Role::sent_memory)) return ChannelEffect::writes;
  if (takes(Role::received_memory)) return ChannelEffect::begins_read;
  if (gives(Role::received_memory)) return ChannelEffect::ends_read;
  if (net_.parts()[net_[id].block].sends) {
    if (!takes(Role::waiting)) return ChannelEffect::writes;
    return net_[id].condition.kind == net::Condition::Kind::elapsed ? ChannelEffect::gives_up
                                                                    : ChannelEffect::is_acknowledged;
  }
  if (takes(Role::full)) return ChannelEffect::begins_read;
  return takes(Role::empty) ? ChannelEffect::skips : ChannelEffect::ends_read;
}

void DeployedNet::find_transitions(const ProcessMap& processes) {
  for (std::uint32_t index = 0; index < transitions_.size(); ++index) {
    const TransitionId id{index};
    const net::Transition& drawn = net_[id];
    Transition& transition = transitions_[index];
    transition.channel = net_.channel_of(id);
    if (drawn.agent.valid()) transition.process = processes.of_agents[drawn.agent];
    if (drawn.role == Step::start_system) start_ = id;
    if (!transition.channel.valid() || !channels_[transition.channel.value].networked) {
      // `timeout` uses no shared place, and is one end of a wait all the same.
      const bool ends_wait = drawn.block.valid() && holds_role(net_, net_.preset(id), PlaceRole::waiting);
      if (!ends_wait || !(*this)[net_.parts()[drawn.block].channel].networked) continue;
      transition.channel = net_.parts()[drawn.block].channel;
    }
    if (is_of_medium(drawn.role)) {
      channels_[transition.channel.value].medium.push_back(move_of(id));
      continue;
    }
    transition.effect = effect_of(id);
    transition.carries_number = net_.channel_of(id).valid();
    channels_[transition.channel.value].sides.push_back(move_of(id));
  }
}

void DeployedNet::join_groups() {
  using Key = std::tuple<net::BlockId, ChannelEffect, std::vector<Arc>, std::vector<Arc>>;
  const auto own = [&](std::span<const Arc> arcs) {
    std::vector<Arc> left;
    std::ranges::copy_if(arcs, std::back_inserter(left),
                         [&](const Arc& arc) { return !net_[arc.place].fused(); });
    return left;
  };
  std::map<Key, std::vector<TransitionId>> groups;
  for (std::uint32_t index = 0; index < transitions_.size(); ++index)
    if (const TransitionId id{index}; transitions_[index].effect != ChannelEffect::none)
      groups[{net_[id].block, transitions_[index].effect, own(net_.preset(id)), own(net_.postset(id))}]
          .push_back(id);
  for (const auto& [key, members] : groups)
    for (const TransitionId id : members)
      for (const TransitionId other : members) transitions_[id.value].moves.push_back(move_of(other));
}

void DeployedNet::find_owners(const ProcessMap& processes) {
  for (std::uint32_t index = 0; index < net_.places().size(); ++index) {
    const net::Place& place = net_.places()[index];
    hidden_.push_back(place.fused() && channels_[place.channel.value].networked);
    const bool local = place.fused() && !hidden_.back();
    process_of_places_.push_back(place.agent.valid() ? processes.of_agents[place.agent]
                                 : local             ? channels_[place.channel.value].sending
                                                     : ProcessId{});
  }
  std::vector<bool> seen(net_.places().size(), false);
  makers_.assign(net_.places().size(), {});
  for (std::uint32_t index = 0; index < transitions_.size(); ++index)
    for (const Arc& arc : net_.postset({index})) {
      const net::SubsystemId subsystem = net_.transitions()[index].subsystem;
      std::optional<net::SubsystemId>& maker = makers_[arc.place.value];
      maker = seen[arc.place.value] && maker != subsystem ? std::nullopt : std::optional(subsystem);
      seen[arc.place.value] = true;
    }
}

}  // namespace tessera::replay
