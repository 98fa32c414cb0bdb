#include "server/analysis/structure.hpp"

#include <fmt/core.h>

#include <map>

namespace tessera::server {

namespace {

using Json = nlohmann::ordered_json;

/// In a model with errors, a number may be invalid.
template <class Id, class Thing>
const Thing* at(const Numbered<Id, Thing>& things, Id id) {
  return things.has(id) ? &things[id] : nullptr;
}

template <class Id>
std::string name_at(const Numbered<Id, spec::Field>& buffers, Id id) {
  const spec::Field* buffer = at(buffers, id);
  return buffer == nullptr ? "?" : buffer->name;
}

Json condition_json(const spec::Condition& condition) {
  if (condition.kind == spec::Condition::Kind::never) return nullptr;
  if (condition.kind == spec::Condition::Kind::always) return true;
  Json list = Json::array();
  for (const spec::Expression& one : condition.expressions)
    list.push_back({{"name", one.name}, {"text", one.text}, {"line", one.span.line}});
  return list;
}

Json when_json(const spec::When& when, const spec::Behaviour& from) {
  switch (when.kind) {
    case spec::When::Kind::always:
      return nullptr;
    case spec::When::Kind::never:
      return "false";
    case spec::When::Kind::error:
      return "error";
    case spec::When::Kind::terminal:
    case spec::When::Kind::named_error: {
      const auto& condition = when.kind == spec::When::Kind::terminal ? from.terminal : from.error;
      const spec::Expression* one = at(condition.expressions, when.expression);
      return one == nullptr ? "?" : one->name;
    }
    case spec::When::Kind::expression:
      return when.text.text;
  }
  return nullptr;
}

Json behaviour_json(const spec::Behaviour& behaviour, const spec::Subsystem& subsystem,
                    const std::string& path) {
  Json json{{"path", path + "." + behaviour.name},
            {"name", behaviour.name},
            {"line", behaviour.span.line},
            {"terminal", condition_json(behaviour.terminal)},
            {"error", condition_json(behaviour.error)},
            {"next", Json::array()},
            {"sends", nullptr},
            {"receives", nullptr},
            {"transfer", behaviour.transfer == spec::Transfer::parallel ? "parallel" : "sequential"}};
  for (const spec::Next& next : behaviour.next) {
    if (next.implied) continue;
    const spec::Behaviour* to = at(subsystem.behaviours, next.behaviour);
    json["next"].push_back({{"to", to == nullptr ? "end" : to->name},
                            {"when", when_json(next.when, behaviour)},
                            {"line", next.span.line},
                            {"given", behaviour.next_given}});
  }
  const auto names = [](const auto& list, const auto& buffers) -> Json {
    if (!list) return nullptr;
    Json listed = Json::array();
    for (const spec::BufferId id : *list) listed.push_back(name_at(buffers, id));
    return listed;
  };
  json["sends"] = names(behaviour.send, subsystem.outputs);
  json["receives"] = names(behaviour.receive, subsystem.inputs);
  return json;
}

Json buffers_json(const spec::Model& model, const std::vector<spec::Field>& buffers,
                  const std::string& path) {
  Json json = Json::array();
  for (const spec::Field& buffer : buffers)
    json.push_back({{"path", path + "." + buffer.name},
                    {"name", buffer.name},
                    {"type", type_text(model, buffer.type)},
                    {"line", buffer.span.line}});
  return json;
}

const char* kind_of(const spec::Subsystem& subsystem) {
  constexpr std::array<const char*, 3> kinds{"control", "receptor", "effector"};
  return kinds[static_cast<std::size_t>(subsystem.kind)];
}

Json seconds_or_null(const std::optional<spec::Duration>& duration) {
  return duration ? Json(std::chrono::duration<double>(*duration).count()) : Json(nullptr);
}

Json subsystem_json(const spec::Model& model, const spec::Subsystem& subsystem, const std::string& agent) {
  const std::string path = agent + "." + subsystem.name;
  const spec::Behaviour* start = at(subsystem.behaviours, subsystem.start);
  Json json{{"path", path},
            {"name", subsystem.name},
            {"kind", kind_of(subsystem)},
            {"line", subsystem.span.line},
            {"rate", nullptr},
            {"start", start == nullptr ? Json(nullptr) : Json(start->name)},
            {"behaviours", Json::array()},
            {"inputs", buffers_json(model, subsystem.inputs, path)},
            {"outputs", buffers_json(model, subsystem.outputs, path)},
            {"memory", buffers_json(model, subsystem.memory, path)}};
  if (subsystem.period && subsystem.period->count() > 0)
    json["rate"] = 1 / std::chrono::duration<double>(*subsystem.period).count();
  for (const spec::Behaviour& behaviour : subsystem.behaviours)
    json["behaviours"].push_back(behaviour_json(behaviour, subsystem, path));
  return json;
}

/// A device is drawn like a subsystem, without a net of its own.
Json real_json(const spec::Model& model, const spec::Subsystem& of, const spec::Field& buffer,
               const std::string& agent, const std::map<std::string, std::string>& drivers) {
  const std::string path = agent + "." + of.name + "." + buffer.name;
  const auto driver = drivers.find(path);
  return {{"path", path},
          {"name", buffer.name},
          {"kind", of.kind == spec::SubsystemKind::receptor ? "real_receptor" : "real_effector"},
          {"of", agent + "." + of.name},
          {"type", type_text(model, buffer.type)},
          {"driver", driver == drivers.end() ? Json(nullptr) : Json(driver->second)},
          {"line", buffer.span.line},
          {"rate", nullptr},
          {"start", nullptr},
          {"behaviours", Json::array()},
          {"inputs", Json::array()},
          {"outputs", Json::array()}};
}

/// An instance of a model that may have errors.
struct Known {
  std::string path;
  const spec::Subsystem* subsystem = nullptr;
};
Known instance(const spec::Model& model, spec::InstanceId id) {
  const spec::Instance* one = at(model.instances, id);
  const spec::Agent* agent = one == nullptr ? nullptr : at(model.agents, one->agent);
  const spec::Definition* definition = agent == nullptr ? nullptr : at(model.definitions, agent->definition);
  const spec::Subsystem* found = definition == nullptr ? nullptr : at(definition->subsystems, one->subsystem);
  return found == nullptr ? Known{} : Known{agent->path + "." + found->name, found};
}

/// "sensor: yaw, shoulder"
std::string text_of(const spec::Driver& driver) {
  std::string text = driver.kind;
  for (const spec::Driver::Target& target : driver.targets)
    text += (&target == &driver.targets.front() ? ": " : ", ") + target.name;
  return text;
}

std::map<std::string, std::string> drivers_of(const spec::Model& model) {
  std::map<std::string, std::string> drivers;
  const auto add = [&](const std::vector<spec::Driver>& list) {
    for (const spec::Driver& driver : list)
      if (const Known known = instance(model, driver.instance); known.subsystem != nullptr)
        for (const spec::RealId buffer : known.subsystem->real.ids())
          if (!driver.real.valid() || driver.real == buffer)
            drivers.emplace(known.path + "." + name_at(known.subsystem->real, buffer), text_of(driver));
  };
  if (model.simulation) add(model.simulation->drivers);
  add(model.drivers);
  return drivers;
}

Json channel_json(const spec::Model& model, spec::ChannelId id) {
  const spec::Channel& channel = model.channels[id];
  const Known from = instance(model, channel.from.instance), to = instance(model, channel.to.instance);
  if (from.subsystem == nullptr || to.subsystem == nullptr) return nullptr;
  constexpr std::array modes{"non_blocking", "blocking", "blocking_once"};
  const auto mode = [&](spec::Mode one) { return modes[static_cast<std::size_t>(one)]; };
  const spec::CommunicationModel* own = at(model.models, channel.model);
  return {{"id", id.value},
          {"from", from.path + "." + name_at(from.subsystem->outputs, channel.from.buffer)},
          {"to", to.path + "." + name_at(to.subsystem->inputs, channel.to.buffer)},
          {"send", mode(channel.send)},
          {"receive", mode(channel.receive)},
          {"model", own == nullptr ? Json(nullptr) : Json(own->name)},
          {"line", channel.span.line},
          {"send_timeout", seconds_or_null(channel.send_timeout)},
          {"receive_timeout", seconds_or_null(channel.receive_timeout)}};
}

}  // namespace

std::string type_text(const spec::Model& model, const spec::Type& type) {
  std::string text;
  switch (type.kind) {
    case spec::Type::Kind::scalar:
      text = name_of(type.scalar);
      break;
    case spec::Type::Kind::string:
      text = fmt::format("string<={}", type.capacity);
      break;
    case spec::Type::Kind::structure:
      text = model.structures.has(type.structure) ? model.structures[type.structure].name : "?";
      break;
  }
  if (type.extent > 0)
    text += type.is_sequence ? fmt::format("<={}", type.extent) : fmt::format("[{}]", type.extent);
  return type.unit.empty() ? text : text + " " + type.unit;
}

Json structure_json(const spec::Model& model) {
  Json json{{"system", model.system}, {"agents", Json::array()}, {"channels", Json::array()}};
  const std::map<std::string, std::string> drivers = drivers_of(model);
  for (const spec::Agent& agent : model.agents) {
    const spec::Definition* definition = at(model.definitions, agent.definition);
    if (definition == nullptr) continue;
    Json one{{"path", agent.path},
             {"name", agent.path},
             {"template", definition->is_template ? Json(definition->name) : Json(nullptr)},
             {"line", agent.span.line},
             {"subsystems", Json::array()}};
    for (const spec::Subsystem& subsystem : definition->subsystems) {
      one["subsystems"].push_back(subsystem_json(model, subsystem, agent.path));
      for (const spec::Field& buffer : subsystem.real)
        one["subsystems"].push_back(real_json(model, subsystem, buffer, agent.path, drivers));
    }
    json["agents"].push_back(std::move(one));
  }
  for (const spec::ChannelId id : model.channels.ids())
    if (Json channel = channel_json(model, id); !channel.is_null())
      json["channels"].push_back(std::move(channel));
  return json;
}

}  // namespace tessera::server
