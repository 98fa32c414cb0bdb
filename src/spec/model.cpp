#include "spec/model.hpp"

#include <algorithm>
#include <array>

namespace tessera::spec {

bool always_continues(const Behaviour& behaviour) {
  const auto asks = [&behaviour](When::Kind kind, Index expression) {
    return std::any_of(behaviour.next.begin(), behaviour.next.end(), [&](const Next& entry) {
      return entry.when.kind == kind && (expression == none || entry.when.expression == expression);
    });
  };
  if (asks(When::Kind::always, none)) return true;
  // Any behaviour may end by an exception, so errors must be asked for even where no error condition is
  // given.
  if (!asks(When::Kind::error, none) || behaviour.terminal.kind == Condition::Kind::always) return false;
  for (Index i = 0; i < behaviour.terminal.expressions.size(); ++i) {
    if (!asks(When::Kind::terminal, i)) return false;
  }
  return true;
}

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
