#include "watch/monitor_protocol.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace tessera {
namespace {

using nlohmann::json;

[[nodiscard]] std::string line_of(const json& object) {
  return object.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
}

[[nodiscard]] json to_json(const Snapshot::Subsystem& subsystem) {
  json all{{"path", subsystem.path},
           {"behaviour", subsystem.behaviour ? json(*subsystem.behaviour) : json()},
           {"calling", subsystem.calling},
           {"ended", subsystem.ended},
           {"iterations", subsystem.iterations},
           {"firings", subsystem.firings},
           {"overruns", subsystem.overruns},
           {"errors", subsystem.errors},
           {"period_s", subsystem.period_s},
           {"called_at_s", subsystem.called_at_s},
           {"call_s", subsystem.call_s},
           {"longest_call_s", subsystem.longest_call_s}};
  for (const MemoryGauge::Field& field : subsystem.memory)
    all["memory"].push_back({{"name", field.name}, {"value", field.value}});
  return all;
}

[[nodiscard]] json to_json(const Snapshot::Channel& channel) {
  json all{{"name", channel.name}, {"marked", channel.marked}};
  if (channel.sending_since_s) all["sending_since_s"] = *channel.sending_since_s;
  return all;
}

[[nodiscard]] json to_json(const Snapshot::Wait& wait) {
  json all{{"subsystem", wait.subsystem},
           {"waits_for", wait.waits_for},
           {"channel", wait.channel},
           {"what", wait.for_answer ? "answer" : "value"},
           {"since_s", wait.since_s}};
  if (!wait.process.empty()) all["process"] = wait.process;
  return all;
}

[[nodiscard]] json to_json(const Snapshot::Link& link) {
  json all{{"process", link.process},       {"reachable", link.reachable},
           {"since_s", link.since_s},       {"sent", link.sent},
           {"repeated", link.repeated},     {"received", link.received},
           {"duplicates", link.duplicates}, {"signs", link.signs},
           {"signs_lost", link.signs_lost}};
  if (!link.host.empty()) all["host"] = link.host;
  if (link.heard_s) all["heard_s"] = *link.heard_s;
  if (link.clock_ahead_s) {
    all["clock_ahead_s"] = *link.clock_ahead_s;
    all["clock_uncertainty_s"] = link.clock_uncertainty_s;
  }
  return all;
}

[[nodiscard]] json to_json(const Snapshot::Deployment& deployment) {
  json processes = json::array();
  for (const Snapshot::Deployment::Process& one : deployment.processes) {
    json process{{"name", one.name}};
    if (!one.host.empty()) process["host"] = one.host;
    processes.push_back(std::move(process));
  }
  return {{"domain", deployment.domain},
          {"interface", deployment.interface},
          {"peers", deployment.peers},
          {"processes", std::move(processes)}};
}

template <class All>
[[nodiscard]] json list_of(const All& all) {
  json list = json::array();
  for (const auto& one : all) list.push_back(to_json(one));
  return list;
}

/// null: it has none. It copies no data, because a copy of a deeply nested value takes a deep stack.
[[nodiscard]] const json& member_of(const json& object, const char* name) {
  static const json none;
  const auto found = object.find(name);
  return found == object.end() ? none : *found;
}

/// A list of names, or one name alone.
[[nodiscard]] std::vector<std::string> names_in(const json& object, const char* list) {
  std::vector<std::string> names;
  for (const json& name : member_of(object, list))
    names.push_back(name.is_string() ? name.get<std::string>() : std::string());
  return names;
}

/// Throws the exception of nlohmann::json if a member has another type.
[[nodiscard]] SimulationCommand simulation_command(const std::string& name, const json& object) {
  if (name == "pause") return commands::Pause{};
  if (name == "resume") return commands::Resume{};
  if (name == "step_firing") return commands::StepFiring{};
  if (name == "step_iteration") return commands::StepIteration{object.value("subsystem", "")};
  if (name == "breakpoints")
    return commands::SetBreakpoints{names_in(object, "places"), names_in(object, "transitions"),
                                    names_in(object, "conditions")};
  if (name != "speed") return commands::Unknown{};
  const json& value = member_of(object, "value");
  return commands::SetSpeed{value.is_number() ? std::optional(value.get<double>()) : std::nullopt};
}

/// Throws as simulation_command.
[[nodiscard]] commands::FeedPanel panel_command(const json& object) {
  PanelInput input{.path = object.at("path"), .who = object.value("operator", ""), .values = {}};
  const json& values = member_of(object, "values");
  if (values.is_null()) return {std::move(input)};
  input.values.emplace();
  for (const auto& [field, value] : values.get_ref<const json::object_t&>()) {
    if (value.is_boolean())
      input.values->emplace_back(field, value.get<bool>());
    else
      input.values->emplace_back(field, value.get<double>());
  }
  return {std::move(input)};
}

/// Throws as simulation_command.
[[nodiscard]] AnsweredCommand answered_command(const json& object) {
  const std::string name = object.value("command", "");
  if (name == "set")
    return commands::SetParameter{object.at("path"), object.at("value"), object.value("try", false)};
  if (name == "panel") return panel_command(object);
  if (name == "emergency_stop")
    return commands::EmergencyStop{object.value("why", "an operator asks for it")};
  if (name == "reset") return commands::Reset{};
  return simulation_command(name, object);
}

}  // namespace

std::string to_line(const Snapshot& snapshot) {
  json all{{"system", snapshot.system},
           {"pid", snapshot.pid},
           {"net_hash", snapshot.net_hash},
           {"time_s", snapshot.time_s},
           {"subsystems", list_of(snapshot.subsystems)},
           {"channels", list_of(snapshot.channels)},
           {"waits", list_of(snapshot.waits)}};
  if (snapshot.process) {
    all["process"] = snapshot.process->name;
    all["host"] = snapshot.process->host;
    all["incarnation"] =
        std::to_string(snapshot.process->incarnation);  // too large for some readers of numbers
    all["links"] = list_of(snapshot.links);
  }
  if (snapshot.deployment) all["deployment"] = to_json(*snapshot.deployment);
  if (snapshot.brief) all["brief"] = true;
  if (snapshot.left_out > 0) all["left_out"] = snapshot.left_out;
  if (snapshot.emergency) all["emergency"] = *snapshot.emergency;
  if (snapshot.recording) all["recording"] = *snapshot.recording;
  if (snapshot.simulation) {
    all["paused"] = snapshot.simulation->paused;
    all["pauses"] = snapshot.simulation->pauses;
    all["speed"] = snapshot.simulation->speed;
    all["broke_at"] = snapshot.simulation->broke_at;
  }
  return line_of(all);
}

std::string answer_line(std::int64_t id, const std::optional<Problem>& wrong, bool is_elsewhere) {
  json answer{{"answer", id}, {"error", wrong ? wrong->text : ""}};
  if (is_elsewhere) answer["elsewhere"] = true;
  return line_of(answer);
}

std::string piece_line(std::size_t bytes, bool begins, bool more) {
  return line_of({{"recording_bytes", bytes}, {"begins", begins}, {"more", more}});
}

std::string scene_line(std::size_t bytes, std::uint64_t from, std::uint64_t total) {
  return line_of({{"scene_bytes", bytes}, {"from", from}, {"total", total}});
}

std::string ended_line() { return line_of({{"ended", true}}); }

Request parse_request(const std::string& line) {
  const json object = json::parse(line, nullptr, /*allow_exceptions=*/false);
  Request request;
  if (!object.is_object()) return request;
  // These have no answer, so their id does not matter.
  const json& name = member_of(object, "command");
  if (name == "own") return {0, commands::Own{}};
  if (name == "recording") return {0, commands::SendRecording{}};
  if (name == "scene") {
    const json& from = member_of(object, "from");
    return {0, commands::SendScene{from.is_number_unsigned() ? from.get<std::uint64_t>() : 0}};
  }
  try {
    request.id = object.value("id", request.id);
    request.command = answered_command(object);
  } catch (const json::exception&) {  // members of another type
  }
  return request;
}

}  // namespace tessera
