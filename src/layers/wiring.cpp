#include "layers/wiring.hpp"

#include <algorithm>

namespace tessera::layers {

const spec::ChannelEnd& end_of(const spec::Channel& channel, Direction direction) {
  return direction == Direction::send ? channel.from : channel.to;
}

Wiring::Wiring(const spec::Model& model)
    : model_(model), outgoing_(model.instances.size()), incoming_(model.instances.size()) {
  for (spec::Index channel = 0; channel < model.channels.size(); ++channel) {
    outgoing_[model.channels[channel].from.instance].push_back(channel);
    incoming_[model.channels[channel].to.instance].push_back(channel);
  }
}

std::vector<spec::Index> Wiring::used(spec::Index instance, const spec::Behaviour& behaviour,
                                      Direction direction) const {
  const bool sends = direction == Direction::send;
  const auto& all = (sends ? outgoing_ : incoming_)[instance];
  const auto& list = sends ? behaviour.send : behaviour.receive;
  if (!list) return all;

  const spec::Subsystem& subsystem = model_.subsystem(instance);
  std::vector<std::size_t> rank((sends ? subsystem.outputs : subsystem.inputs).size(), list->size());
  for (std::size_t position = list->size(); position-- > 0;) rank[(*list)[position]] = position;
  const auto rank_of = [&](spec::Index channel) {
    return rank[end_of(model_.channels[channel], direction).buffer];
  };
  std::vector<spec::Index> listed;
  std::ranges::copy_if(all, std::back_inserter(listed),
                       [&](spec::Index channel) { return rank_of(channel) < list->size(); });
  std::ranges::stable_sort(listed, {}, rank_of);
  return listed;
}

std::vector<bool> Wiring::used_channels() const {
  std::vector<bool> any(model_.channels.size(), false);
  for (spec::Index instance = 0; instance < model_.instances.size(); ++instance)
    for (const spec::Behaviour& behaviour : model_.subsystem(instance).behaviours)
      for (const Direction direction : {Direction::send, Direction::receive})
        for (const spec::Index channel : used(instance, behaviour, direction)) any[channel] = true;
  return any;
}

}  // namespace tessera::layers
