#include "project/process/control_messages.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace tessera::project {

namespace {

using nlohmann::json;

/// Throws json::exception if the member is of another type.
template <class Value>
void read_member(const json& object, const char* name, Value& value) {
  if (const auto found = object.find(name); found != object.end()) found->get_to(value);
}

/// As above; null is as good as missing.
template <class Value>
void read_member(const json& object, const char* name, std::optional<Value>& value) {
  const auto found = object.find(name);
  if (found != object.end() && !found->is_null()) value = found->template get<Value>();
}

/// Throws json::exception if it is none.
const json& an_object(const json& value) {
  static_cast<void>(value.get_ref<const json::object_t&>());
  return value;
}

/// A list of objects; empty: it is missing. Throws as an_object.
const json::array_t& list_in(const json& object, const char* name) {
  static const json::array_t none;
  const auto found = object.find(name);
  return found == object.end() ? none : found->get_ref<const json::array_t&>();
}

Snapshot::Subsystem read_subsystem(const json& object) {
  Snapshot::Subsystem one;
  read_member(object, "path", one.path);
  read_member(object, "behaviour", one.behaviour);
  read_member(object, "calling", one.calling);
  read_member(object, "ended", one.ended);
  read_member(object, "iterations", one.iterations);
  read_member(object, "firings", one.firings);
  read_member(object, "overruns", one.overruns);
  read_member(object, "errors", one.errors);
  read_member(object, "period_s", one.period_s);
  read_member(object, "called_at_s", one.called_at_s);
  read_member(object, "call_s", one.call_s);
  read_member(object, "longest_call_s", one.longest_call_s);
  for (const json& field : list_in(object, "memory")) {
    Snapshot::Subsystem::MemoryField& read = one.memory.emplace_back();
    read_member(an_object(field), "name", read.name);
    read_member(field, "value", read.value);
  }
  return one;
}

Snapshot::Channel read_channel(const json& object) {
  Snapshot::Channel one;
  read_member(object, "name", one.name);
  read_member(object, "marked", one.marked);
  read_member(object, "sending_since_s", one.sending_since_s);
  return one;
}

Snapshot::Wait read_wait(const json& object) {
  Snapshot::Wait one;
  read_member(object, "subsystem", one.subsystem);
  read_member(object, "waits_for", one.waits_for);
  read_member(object, "channel", one.channel);
  one.for_answer = object.value("what", std::string()) == "answer";
  read_member(object, "process", one.process);
  read_member(object, "since_s", one.since_s);
  return one;
}

Snapshot::Link read_link(const json& object) {
  Snapshot::Link one;
  read_member(object, "process", one.process);
  read_member(object, "host", one.host);
  read_member(object, "reachable", one.reachable);
  read_member(object, "since_s", one.since_s);
  read_member(object, "heard_s", one.heard_s);
  read_member(object, "sent", one.sent);
  read_member(object, "repeated", one.repeated);
  read_member(object, "received", one.received);
  read_member(object, "duplicates", one.duplicates);
  read_member(object, "signs", one.signs);
  read_member(object, "signs_lost", one.signs_lost);
  read_member(object, "clock_ahead_s", one.clock_ahead_s);
  read_member(object, "clock_uncertainty_s", one.clock_uncertainty_s);
  return one;
}

Snapshot::Control read_control(const json& object) {
  Snapshot::Control control;
  read_member(object, "paused", control.paused);
  read_member(object, "pauses", control.pauses);
  read_member(object, "speed", control.speed);
  read_member(object, "broke_at", control.broke_at);
  return control;
}

Snapshot::Deployment read_deployment(const json& object) {
  Snapshot::Deployment read;
  read_member(object, "domain", read.domain);
  read_member(object, "interface", read.interface);
  read_member(object, "peers", read.peers);
  for (const json& one : list_in(object, "processes")) {
    Snapshot::Deployment::Process& process = read.processes.emplace_back();
    read_member(an_object(one), "name", process.name);
    read_member(one, "host", process.host);
  }
  return read;
}

Snapshot read_snapshot(const json& object) {
  Snapshot snapshot;
  read_member(object, "system", snapshot.system);
  read_member(object, "net_hash", snapshot.net_hash);
  read_member(object, "pid", snapshot.process);
  read_member(object, "time_s", snapshot.time_s);
  read_member(object, "recording", snapshot.recording);
  read_member(object, "emergency", snapshot.emergency);
  for (const json& one : object.value("subsystems", json::array()))
    snapshot.subsystems.push_back(read_subsystem(an_object(one)));
  for (const json& one : object.value("channels", json::array()))
    snapshot.channels.push_back(read_channel(an_object(one)));
  read_member(object, "process", snapshot.name);
  read_member(object, "host", snapshot.host);
  read_member(object, "incarnation", snapshot.incarnation);
  for (const json& one : object.value("waits", json::array()))
    snapshot.waits.push_back(read_wait(an_object(one)));
  for (const json& one : object.value("links", json::array()))
    snapshot.links.push_back(read_link(an_object(one)));
  if (const auto found = object.find("deployment"); found != object.end())
    snapshot.deployment = read_deployment(an_object(*found));
  read_member(object, "brief", snapshot.brief);
  read_member(object, "left_out", snapshot.left_out);
  if (object.contains("paused")) snapshot.control = read_control(object);
  return snapshot;
}

PieceHead read_piece_head(const json& object) {
  PieceHead head;
  read_member(object, "recording_bytes", head.bytes);
  read_member(object, "begins", head.begins);
  read_member(object, "more", head.more);
  return head;
}

SceneHead read_scene_head(const json& object) {
  SceneHead head;
  read_member(object, "scene_bytes", head.bytes);
  read_member(object, "from", head.from);
  read_member(object, "total", head.total);
  return head;
}

CommandAnswer read_answer(const json& object) {
  CommandAnswer answer;
  read_member(object, "answer", answer.id);
  if (std::string error = object.value("error", std::string()); !error.empty())
    answer.problem = Problem{std::move(error)};
  read_member(object, "elsewhere", answer.elsewhere);
  return answer;
}

// ------------------------------------------------------------------------------------------------ commands

json json_of(const command::Recording&) { return {{"command", "recording"}}; }
json json_of(const command::Scene& scene) { return {{"command", "scene"}, {"from", scene.from}}; }
json json_of(const command::Own&) { return {{"command", "own"}}; }
json json_of(const command::Set& set) {
  json object{{"command", "set"}, {"path", set.path}, {"value", set.value}};
  if (set.only_try) object["try"] = true;
  return object;
}
json json_of(const command::Panel& panel) {
  json object{{"command", "panel"}, {"path", panel.path}, {"operator", panel.who}};
  if (!panel.values) return object;
  json values = json::object();
  for (const auto& [field, value] : *panel.values) {
    json& written = values[field];
    std::visit([&](const auto& one) { written = one; }, value);
  }
  object["values"] = std::move(values);
  return object;
}
json json_of(const command::EmergencyStop& stop) {
  json object{{"command", "emergency_stop"}};
  if (!stop.why.empty()) object["why"] = stop.why;
  return object;
}
json json_of(const command::Reset&) { return {{"command", "reset"}}; }
json json_of(const command::Pause&) { return {{"command", "pause"}}; }
json json_of(const command::Resume&) { return {{"command", "resume"}}; }
json json_of(const command::StepFiring&) { return {{"command", "step_firing"}}; }
json json_of(const command::StepIteration& step) {
  return {{"command", "step_iteration"}, {"subsystem", step.subsystem}};
}
json json_of(const command::Speed& speed) { return {{"command", "speed"}, {"value", speed.value}}; }
json json_of(const command::Breakpoints& breakpoints) {
  return {{"command", "breakpoints"},
          {"places", breakpoints.places},
          {"transitions", breakpoints.transitions},
          {"conditions", breakpoints.conditions}};
}

}  // namespace

std::optional<ControlLine> read_control_line(std::string_view line) try {
  const json object = json::parse(line);
  if (!object.is_object()) return std::nullopt;
  if (object.contains("recording_bytes")) return read_piece_head(object);
  if (object.contains("scene_bytes")) return read_scene_head(object);
  if (object.contains("ended")) return ControllerHasEnded{};
  if (object.contains("answer")) return read_answer(object);
  return read_snapshot(object);
} catch (const json::exception&) {
  return std::nullopt;
}

json json_of(const std::vector<Snapshot::Subsystem>& subsystems) {
  json list = json::array();
  for (const Snapshot::Subsystem& one : subsystems)
    list.push_back({{"path", one.path},
                    {"behaviour", one.behaviour ? json(*one.behaviour) : json(nullptr)},
                    {"calling", one.calling},
                    {"ended", one.ended},
                    {"iterations", one.iterations},
                    {"firings", one.firings},
                    {"overruns", one.overruns},
                    {"errors", one.errors},
                    {"period_s", one.period_s},
                    {"called_at_s", one.called_at_s},
                    {"call_s", one.call_s},
                    {"longest_call_s", one.longest_call_s}});
  return list;
}

json json_of(const std::vector<Snapshot::Channel>& channels) {
  json list = json::array();
  for (const Snapshot::Channel& one : channels) list.push_back({{"name", one.name}, {"marked", one.marked}});
  return list;
}

std::string line_of(const ControlCommand& command, std::optional<std::int64_t> id) {
  json object = std::visit([](const auto& one) { return json_of(one); }, command);
  if (id) object["id"] = *id;
  return object.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace tessera::project
