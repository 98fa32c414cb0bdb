#include "spec/model.hpp"

#include <array>

namespace tessera::spec {

std::string_view name_of(Property::Kind kind) {
  constexpr std::array<std::string_view, 5> names{"never", "always", "reachable", "always_reachable",
                                                  "leads_to"};
  return names.at(static_cast<std::size_t>(kind));
}

const Subsystem& Model::subsystem(Index instance) const {
  const Instance& one = instances[instance];
  return definition_of(agents[one.agent]).subsystems[one.subsystem];
}

std::string Model::instance_path(Index instance) const {
  return agents[instances[instance].agent].path + "." + subsystem(instance).name;
}

std::string Model::channel_name(const Channel& channel) const {
  return instance_path(channel.from.instance) + "." +
         subsystem(channel.from.instance).outputs[channel.from.buffer].name + "->" +
         instance_path(channel.to.instance) + "." +
         subsystem(channel.to.instance).inputs[channel.to.buffer].name;
}

bool Model::sender_waits(const Channel& channel) const {
  return channel.model == none ? channel.send == Mode::blocking : models[channel.model].send.waits;
}

bool Model::receiver_waits(const Channel& channel) const {
  return channel.model == none ? channel.receive == Mode::blocking : models[channel.model].receive.waits;
}

}  // namespace tessera::spec
