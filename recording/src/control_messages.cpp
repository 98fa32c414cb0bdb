#include "tessera/control_messages.hpp"

#include <concepts>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

namespace tessera {
namespace {

using nlohmann::json;

/// A member that is `by_need` is left out of a line while it has its default.
enum class Presence : std::uint8_t { always, by_need };
using enum Presence;

// The members of each message and their names in a line. `each` writes them or reads them.

template <class One, class Message>
concept Is = std::same_as<std::remove_const_t<One>, Message>;

void members(Is<Snapshot::MemoryField> auto& one, auto& each) {
  each("name", one.name);
  each("value", one.value);
}

void members(Is<Snapshot::Subsystem> auto& one, auto& each) {
  each("path", one.path);
  each("behaviour", one.behaviour);
  each("calling", one.calling), each("ended", one.ended);
  each("iterations", one.iterations);
  each("firings", one.firings);
  each("overruns", one.overruns);
  each("errors", one.errors);
  each("period_s", one.period_s);
  each("called_at_s", one.called_at_s);
  each("call_s", one.call_s), each("longest_call_s", one.longest_call_s);
  each("slow_calls", one.slow_calls, by_need), each("late_wakeups", one.late_wakeups, by_need);
  each("latest_wakeup_s", one.latest_wakeup_s, by_need);
  each("memory", one.memory, by_need);
}

void members(Is<Snapshot::Channel> auto& one, auto& each) {
  each("name", one.name);
  each("marked", one.marked);
  each("sending_since_s", one.sending_since_s, by_need);
}

void members(Is<Snapshot::Wait> auto& one, auto& each) {
  each("subsystem", one.subsystem);
  each("waits_for", one.waits_for);
  each("channel", one.channel);
  each.word("what", one.for_answer, "value", "answer");
  each("process", one.process, by_need);
  each("since_s", one.since_s);
}

void members(Is<Snapshot::Link> auto& one, auto& each) {
  each("process", one.process);
  each("host", one.host, by_need);
  each("reachable", one.reachable);
  each("since_s", one.since_s);
  each("heard_s", one.heard_s, by_need);
  each("sent", one.sent);
  each("repeated", one.repeated);
  each("received", one.received);
  each("duplicates", one.duplicates);
  each("signs", one.signs);
  each("signs_lost", one.signs_lost);
  each("clock_ahead_s", one.clock_ahead_s, by_need);
  each("clock_uncertainty_s", one.clock_uncertainty_s, by_need);
}

void members(Is<Snapshot::Deployment::Process> auto& one, auto& each) {
  each("name", one.name);
  each("host", one.host, by_need);
}

void members(Is<Snapshot::Deployment> auto& one, auto& each) {
  each("domain", one.domain);
  each("interface", one.interface);
  each("peers", one.peers);
  each("processes", one.processes);
}

void members(Is<Snapshot::Control> auto& one, auto& each) {
  each("paused", one.paused);
  each("pauses", one.pauses);
  each("speed", one.speed);
  each("broke_at", one.broke_at);
}

void members(Is<Snapshot> auto& one, auto& each) {
  each("system", one.system);
  each("pid", one.pid);
  each("net_hash", one.net_hash);
  each("time_s", one.time_s);
  each("recording", one.recording, by_need);
  each("emergency", one.emergency, by_need);
  each("process", one.process, by_need);
  each("host", one.host, by_need);
  each("incarnation", one.incarnation, by_need);
  each("subsystems", one.subsystems);
  each("channels", one.channels);
  each("waits", one.waits);
  each("links", one.links, by_need);
  each.flat("paused", one.control);
  each("deployment", one.deployment, by_need);
  each("brief", one.brief, by_need);
  each("left_out", one.left_out, by_need);
}

void members(Is<Offered::Value> auto& one, auto& each) {
  each("path", one.path);
  each("value", one.value);
  each("unit", one.unit, by_need);
  each("minimum", one.minimum, by_need);
  each("maximum", one.maximum, by_need);
}

void members(Is<Offered::Panel> auto& one, auto& each) {
  each("path", one.path);
  each("stale_s", one.stale_s);
  each("operated", one.operated);
  each("controls", one.controls);
}

void members(Is<Offered> auto& one, auto& each) {
  each("parameters", one.parameters);
  each("panels", one.panels);
}

void members(Is<PieceHead> auto& one, auto& each) {
  each("recording_bytes", one.bytes);
  each("begins", one.begins);
  each("more", one.more);
}

void members(Is<SceneHead> auto& one, auto& each) {
  each("scene_bytes", one.bytes);
  each("from", one.from);
  each("total", one.total);
}

void members(Is<command::Scene> auto& one, auto& each) { each("from", one.from); }

void members(Is<command::Set> auto& one, auto& each) {
  each("path", one.path);
  each("value", one.value);
  each("try", one.only_try, by_need);
}

void members(Is<command::Panel> auto& one, auto& each) {
  each("path", one.path);
  each("operator", one.who, by_need);
  each("values", one.values, by_need);
}

void members(Is<command::EmergencyStop> auto& one, auto& each) { each("why", one.why, by_need); }

void members(Is<command::StepIteration> auto& one, auto& each) { each("subsystem", one.subsystem, by_need); }

void members(Is<command::Speed> auto& one, auto& each) { each("value", one.value); }

void members(Is<command::Breakpoints> auto& one, auto& each) {
  each("places", one.places, by_need);
  each("transitions", one.transitions, by_need);
  each("conditions", one.conditions, by_need);
}

/// Commands without members.
template <class One>
requires std::is_empty_v<One>
void members(One& /*one*/, auto& /*each*/) {}

// ------------------------------------------------------------------------------------------------- writing

template <class Value>
[[nodiscard]] json json_of(const Value& value);

class Writer {
 public:
  explicit Writer(json& into) : into_(into) {}

  template <class Value>
  void operator()(const char* name, const Value& value, Presence presence = always) {
    if (presence == always || !is_default(value)) into_[name] = json_of(value);
  }
  void word(const char* name, bool value, const char* if_false, const char* if_true) {
    into_[name] = value ? if_true : if_false;
  }
  /// The members of the part stand among those of the whole.
  template <class Part>
  void flat(const char* /*first*/, const std::optional<Part>& part) {
    if (part) members(*part, *this);
  }

 private:
  template <class Value>
  [[nodiscard]] static bool is_default(const Value& value) {
    if constexpr (requires { value.has_value(); })
      return !value.has_value();
    else if constexpr (requires { value.empty(); })
      return value.empty();
    else
      return value == Value{};
  }
  json& into_;
};

template <class Value>
json json_of(const Value& value) {
  if constexpr (requires { value.has_value(); }) {
    return value ? json_of(*value) : json();
  } else if constexpr (std::is_same_v<Value, command::Panel::Value>) {
    return std::visit([](const auto& one) { return json(one); }, value);
  } else if constexpr (requires { typename Value::mapped_type; }) {
    json all = json::object();
    for (const auto& [name, one] : value) all[name] = json_of(one);
    return all;
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
    return value;
  } else if constexpr (requires { typename Value::value_type; }) {
    json all = json::array();
    for (const auto& one : value) all.push_back(json_of(one));
    return all;
  } else {
    json all = json::object();
    Writer writer(all);
    members(value, writer);
    return all;
  }
}

[[nodiscard]] std::string text_of(const json& object) {
  return object.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
}

// ------------------------------------------------------------------------------------------------- reading

/// These throw json::exception if a value has another type. They copy no data, because a copy of a deeply nested
/// value takes a deep stack.
template <class Value>
void read_value(const json& from, Value& value, Presence missing);

/// missing: `always` refuses an object without a member that is always there; `by_need` keeps its default.
class Reader {
 public:
  Reader(const json& from, Presence missing) : from_(from), missing_(missing) {
    static_cast<void>(from.get_ref<const json::object_t&>());
  }

  template <class Value>
  void operator()(const char* name, Value& value, Presence presence = always) {
    if (const auto found = from_.find(name); found != from_.end())
      read_value(*found, value, missing_);
    else if (presence == always && missing_ == always)
      static_cast<void>(from_.at(name));
  }
  void word(const char* name, bool& value, const char* /*if_false*/, const char* if_true) {
    std::string word;
    (*this)(name, word);
    value = word == if_true;
  }
  template <class Part>
  void flat(const char* first, std::optional<Part>& part) {
    if (!from_.contains(first)) return;
    Part present;
    members(present, *this);
    part = std::move(present);
  }

 private:
  const json& from_;
  Presence missing_;
};

template <class Value>
void read_value(const json& from, Value& value, Presence missing) {
  if constexpr (requires { value.has_value(); }) {
    if (from.is_null()) return;
    typename Value::value_type present{};
    read_value(from, present, missing);
    value = std::move(present);
  } else if constexpr (std::is_same_v<Value, command::Panel::Value>) {
    if (from.is_boolean())
      value = from.get<bool>();
    else
      value = from.get<double>();
  } else if constexpr (requires { typename Value::mapped_type; }) {
    for (const auto& [name, one] : from.get_ref<const json::object_t&>())
      read_value(one, value[name], missing);
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
    from.get_to(value);
  } else if constexpr (requires { typename Value::value_type; }) {
    for (const json& one : from.get_ref<const json::array_t&>())
      read_value(one, value.emplace_back(), missing);
  } else {
    Reader reader(from, missing);
    members(value, reader);
  }
}

template <class Message>
[[nodiscard]] Message message_in(const json& object, Presence missing = by_need) {
  Message message;
  read_value(object, message, missing);
  return message;
}

[[nodiscard]] CommandAnswer answer_in(const json& object) {
  CommandAnswer answer;
  std::string error;
  Reader reader(object, by_need);
  reader("answer", answer.id);
  reader("error", error);
  reader("elsewhere", answer.elsewhere);
  reader("offered", answer.offered);
  if (!error.empty()) answer.problem = Problem{std::move(error)};
  return answer;
}

// ------------------------------------------------------------------------------------------------ commands

template <class Command>
[[nodiscard]] json object_of(const Command& command) {
  json object = json_of(command);
  object["command"] = Command::name;
  return object;
}
[[nodiscard]] json object_of(const SimulationCommand& command) {
  return std::visit([](const auto& one) { return object_of(one); }, command);
}

/// The command with that name; nullopt: there is none. Throws as `read_value`.
template <class... Commands>
[[nodiscard]] std::optional<ControlCommand> command_in(const json& object, const std::string& name,
                                                       const std::variant<Commands...>* /*which*/) {
  std::optional<ControlCommand> found;
  const auto try_one = [&]<class Command>(const Command* /*which*/) {
    if constexpr (std::is_same_v<Command, SimulationCommand>) {
      if (!found) found = command_in(object, name, static_cast<const SimulationCommand*>(nullptr));
    } else if (name == Command::name) {
      found = message_in<Command>(object, always);
    }
  };
  (try_one(static_cast<const Commands*>(nullptr)), ...);
  return found;
}

}  // namespace

std::string line_of(const Snapshot& snapshot) { return text_of(json_of(snapshot)); }
std::string line_of(const PieceHead& head) { return text_of(json_of(head)); }
std::string line_of(const SceneHead& head) { return text_of(json_of(head)); }
std::string line_of(const ControllerHasEnded& /*end*/) { return text_of({{"ended", true}}); }
std::string line_of(const CommandAnswer& answer) {
  json object{{"answer", answer.id}, {"error", answer.problem ? answer.problem->text : ""}};
  if (answer.elsewhere) object["elsewhere"] = true;
  if (answer.offered) object["offered"] = json_of(*answer.offered);
  return text_of(object);
}

std::optional<ControlLine> read_control_line(std::string_view line) try {
  const json object = json::parse(line);
  if (!object.is_object()) return std::nullopt;
  if (object.contains("recording_bytes")) return message_in<PieceHead>(object);
  if (object.contains("scene_bytes")) return message_in<SceneHead>(object);
  if (object.contains("ended")) return ControllerHasEnded{};
  if (object.contains("answer")) return answer_in(object);
  return message_in<Snapshot>(object);
} catch (const json::exception&) {
  return std::nullopt;
}

std::string line_of(const ControlCommand& command, std::optional<std::int64_t> id) {
  json object = std::visit([](const auto& one) { return object_of(one); }, command);
  if (id) object["id"] = *id;
  return text_of(object);
}

ControlRequest read_control_request(std::string_view line) {
  ControlRequest request{.id = 0, .command = Problem{"this is no command"}};
  const json object = json::parse(line, nullptr, /*allow_exceptions=*/false);
  try {
    std::string name;
    Reader reader(object, always);
    reader("id", request.id, by_need);
    reader("command", name);
    if (std::optional<ControlCommand> known =
            command_in(object, name, static_cast<const ControlCommand*>(nullptr)))
      request.command = *std::move(known);
    else
      request.command = Problem{"there is no such command"};
  } catch (const json::exception&) {  // members that are missing or of another type
  }
  return request;
}

}  // namespace tessera
