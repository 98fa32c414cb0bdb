#include "layers/wiring.hpp"

#include <algorithm>

namespace tessera::layers {

const spec::ChannelEnd& end_of(const spec::Channel& channel, Direction direction) {
  return direction == Direction::send ? channel.from : channel.to;
}

Wiring::Wiring(const spec::Model& model)
    : model_(model), outgoing_(model.instances.size()), incoming_(model.instances.size()) {
  for (const spec::ChannelId channel : model.channels.ids()) {
    outgoing_[model.channels[channel].from.instance].push_back(channel);
    incoming_[model.channels[channel].to.instance].push_back(channel);
  }
}

std::vector<spec::ChannelId> Wiring::used(spec::InstanceId instance, const spec::Behaviour& behaviour,
                                          Direction direction) const {
  const bool sends = direction == Direction::send;
  const auto& all = (sends ? outgoing_ : incoming_)[instance];
  const auto& list = sends ? behaviour.send : behaviour.receive;
  if (!list) return all;

  const spec::Subsystem& subsystem = model_.subsystem(instance);
  Numbered<spec::BufferId, std::size_t> rank((sends ? subsystem.outputs : subsystem.inputs).size(),
                                             list->size());
  for (std::size_t position = list->size(); position-- > 0;) rank[(*list)[position]] = position;
  const auto rank_of = [&](spec::ChannelId channel) {
    return rank[end_of(model_.channels[channel], direction).buffer];
  };
  std::vector<spec::ChannelId> listed;
  std::ranges::copy_if(all, std::back_inserter(listed),
                       [&](spec::ChannelId channel) { return rank_of(channel) < list->size(); });
  std::ranges::stable_sort(listed, {}, rank_of);
  return listed;
}

Numbered<spec::ChannelId, bool> Wiring::used_channels() const {
  Numbered<spec::ChannelId, bool> any(model_.channels.size(), false);
  for (const spec::InstanceId instance : model_.instances.ids())
    for (const spec::Behaviour& behaviour : model_.subsystem(instance).behaviours)
      for (const Direction direction : {Direction::send, Direction::receive})
        for (const spec::ChannelId channel : used(instance, behaviour, direction)) any[channel] = true;
  return any;
}

}  // namespace tessera::layers
