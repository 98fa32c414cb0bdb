#include "spec/model/model.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace tessera::spec {

std::string_view name_of(Property::Kind kind) {
  constexpr std::array<std::string_view, 5> names{"never", "always", "reachable", "always_reachable",
                                                  "leads_to"};
  return names.at(static_cast<std::size_t>(kind));
}

std::string Model::layout_of(const Type& type) const {
  std::string text;
  switch (type.kind) {
    case Type::Kind::scalar:
      text = name_of(type.scalar);
      break;
    case Type::Kind::string:
      text = "string(" + std::to_string(type.capacity) + ")";
      break;
    case Type::Kind::structure:
      for (const Field& field : structures[type.structure].fields)
        text += (text.empty() ? "" : ", ") + field.name + ": " + layout_of(field.type);
      text = "{" + text + "}";
  }
  if (type.extent == 0) return text;
  return text + (type.is_sequence ? "[<=" : "[") + std::to_string(type.extent) + "]";
}

namespace {

/// Whether the field lies in the part, or is it. An empty part is the whole buffer.
bool lies_in(std::string_view field, std::string_view part) {
  return field.starts_with(part) &&
         (part.empty() || field.size() == part.size() || field[part.size()] == '.');
}

}  // namespace

std::string_view Behaviour::label() const {
  // npos + 1 is 0
  return std::string_view(name).substr(name.rfind('.') + 1);
}

std::string Behaviour::identifier() const {
  std::string text = name;
  std::ranges::replace(text, '.', '_');
  return text;
}

const Skippable* Behaviour::skips(BufferId output) const {
  for (const Skippable& one : skippable)
    if (one.output == output) return &one;
  return nullptr;
}

bool Subsystem::may_be_non_finite(RealId buffer, std::string_view field) const {
  bool allowed = non_finite_allowed;
  std::size_t nearest = 0;
  for (const NonFinite& rule : non_finite) {
    if (rule.real != buffer || !lies_in(field, rule.field) || rule.field.size() < nearest) continue;
    allowed = rule.allowed;
    nearest = rule.field.size();
  }
  return allowed;
}

bool Subsystem::divides_non_finite(RealId buffer, std::string_view field) const {
  for (const NonFinite& rule : non_finite)
    if (rule.real == buffer && rule.field.size() > field.size() && lies_in(rule.field, field)) return true;
  return false;
}

const Subsystem& Model::subsystem(InstanceId instance) const {
  const Instance& one = instances[instance];
  return definition_of(agents[one.agent]).subsystems[one.subsystem];
}

std::string Model::instance_path(InstanceId instance) const {
  return agents[instances[instance].agent].path + "." + subsystem(instance).name;
}

std::string Model::driver_path(const Driver& driver) const {
  const std::string path = instance_path(driver.instance);
  return driver.real.valid() ? path + "." + subsystem(driver.instance).real[driver.real].name : path;
}

std::vector<std::string> Model::without_driver(const std::vector<Driver>& those) const {
  std::set<std::pair<InstanceId, RealId>> driven;
  for (const Driver& driver : those) driven.emplace(driver.instance, driver.real);
  std::vector<std::string> missing;
  for (const InstanceId instance : instances.ids()) {
    if (driven.contains({instance, RealId{}})) continue;
    const auto& real = subsystem(instance).real;
    for (const RealId buffer : real.ids())
      if (!driven.contains({instance, buffer}))
        missing.push_back(instance_path(instance) + "." + real[buffer].name);
  }
  return missing;
}

std::string Model::channel_name(const Channel& channel) const {
  return instance_path(channel.from.instance) + "." +
         subsystem(channel.from.instance).outputs[channel.from.buffer].name + "->" +
         instance_path(channel.to.instance) + "." +
         subsystem(channel.to.instance).inputs[channel.to.buffer].name;
}

bool Model::sender_waits(const Channel& channel) const {
  return channel.model.valid() ? models[channel.model].send.waits : channel.send == Mode::blocking;
}

bool Model::receiver_waits(const Channel& channel) const {
  return channel.model.valid() ? models[channel.model].receive.waits : channel.receive == Mode::blocking;
}

bool Model::crosses_processes(const Channel& channel) const {
  if (!deployment) return false;
  const auto process = [&](const ChannelEnd& end) { return agents[instances[end.instance].agent].process; };
  return process(channel.from) != process(channel.to);
}

}  // namespace tessera::spec
