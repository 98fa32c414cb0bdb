#include "bag/event_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "bag/value_json.hpp"
#include "ros2/codec/cdr.hpp"
#include "tessera/net_roles.hpp"

namespace tessera::bag {
namespace {

std::string subsystem_of(const Recording& recording, const Event& event) {
  return event.instance() < recording.instances.size() ? recording.instances[event.instance()] : "system";
}

/// Values and poses have channels of their own, and the others belong to the file of a recording.
bool has_event(Event::Kind kind) {
  using enum Event::Kind;
  return kind != value && kind != poses && kind != marking && kind != end;
}

std::string firing_members(const Recording& recording, const Event& event) {
  const Recording::Transition& transition = recording.transitions[event.subject];
  std::string text = fmt::format(R"(,"transition":{},"step":"{}")", json_text(transition.name),
                                 name_of(transition.role.step));
  if (!transition.role.behaviour.empty()) text += ",\"behaviour\":" + json_text(transition.role.behaviour);
  if (transition.role.channel)
    text += fmt::format(R"(,"channel":{},"version":{})",
                        json_text(recording.channels[*transition.role.channel]), event.version);
  return text;
}

std::string members(const Recording& recording, const Recording::Entry& entry) {
  const Event& event = entry.event;
  switch (event.kind()) {
    case Event::Kind::firing:
      return firing_members(recording, event);
    case Event::Kind::call:
      return fmt::format(R"(,"behaviour":{},"iteration":{})",
                         json_text(recording.behaviours[event.instance()][event.subject]), event.version);
    case Event::Kind::overrun:
      return fmt::format(R"(,"missed":{})", event.subject);
    case Event::Kind::fault:
      return fmt::format(R"(,"fault":"{}","text":{})", name_of(event.fault()), json_text(entry.text));
    default:
      return fmt::format(R"(,"number":{},"text":{})", event.version, json_text(entry.text));
  }
}

constexpr std::uint8_t level_info = 20, level_warn = 30, level_error = 40;

/// The level of ROS 2; 0: nothing for people.
std::uint8_t level_of(const Event& event) {
  switch (event.kind()) {
    case Event::Kind::log:
      return event.version == 0 ? level_info : event.version == 1 ? level_warn : level_error;
    case Event::Kind::stop:
      return event.version == 0 ? level_info : level_error;
    case Event::Kind::fault:
      return event.is_told_fault() ? level_warn : level_error;
    case Event::Kind::overrun:
      return level_warn;
    case Event::Kind::safe:
      return event.version == static_cast<std::uint32_t>(SafeEvent::refused) ? level_error : level_warn;
    case Event::Kind::parameter:
    case Event::Kind::process:
      return level_info;
    default:
      return 0;
  }
}

std::string log_text(const Recording::Entry& entry) {
  const Event& event = entry.event;
  switch (event.kind()) {
    case Event::Kind::overrun:
      return fmt::format("{} instants of its rate missed", event.subject);
    case Event::Kind::fault:
      return fmt::format("fault ({}): {}", name_of(event.fault()), entry.text);
    case Event::Kind::parameter:
      return "parameter: " + entry.text;
    case Event::Kind::process:
      return fmt::format("process {} {}", entry.text.substr(0, entry.text.find('\n')),
                         event.version == 0 ? "has died" : "begins again");
    default:
      return entry.text;
  }
}

}  // namespace

RosTime ros_time(std::int64_t time_ns) {
  constexpr std::uint64_t second_ns = 1'000'000'000;
  const std::uint64_t time = bag_time(time_ns);
  return {static_cast<std::int32_t>(time / second_ns), static_cast<std::uint32_t>(time % second_ns)};
}

ChannelPlan events_plan() {
  constexpr const char* schema =
      R"({"title":"tessera.Event","type":"object","properties":{)"
      R"("kind":{"type":"string"},"subsystem":{"type":"string"},"sequence":{"type":"integer"},)"
      R"("transition":{"type":"string"},"step":{"type":"string"},"behaviour":{"type":"string"},)"
      R"("channel":{"type":"string"},"version":{"type":"integer"},"iteration":{"type":"integer"},)"
      R"("missed":{"type":"integer"},"fault":{"type":"string"},"number":{"type":"integer"},)"
      R"("text":{"type":"string"}}})";
  return {{0, "tessera.Event", "jsonschema", schema}, {0, 0, "/tessera/events", "json", {}}};
}

std::optional<std::string> event_of(const Recording& recording, const Recording::Entry& entry) {
  const std::string_view kind = name_of(entry.event.kind());
  if (kind.empty() || !has_event(entry.event.kind())) return std::nullopt;
  return fmt::format(R"({{"kind":"{}","subsystem":{},"sequence":{}{}}})", kind,
                     json_text(subsystem_of(recording, entry.event)), entry.event.sequence,
                     members(recording, entry));
}

ChannelPlan log_plan() {
  const std::string definition = std::string(
                                     "byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\n"
                                     "byte FATAL=50\nbuiltin_interfaces/Time stamp\nuint8 level\n"
                                     "string name\nstring msg\nstring file\nstring function\n"
                                     "uint32 line") +
                                 definition_line + time_definition + "\n";
  return {{0, "rcl_interfaces/msg/Log", "ros2msg", definition}, {0, 0, "/rosout", "cdr", {}}};
}

std::optional<std::string> log_of(const Recording& recording, const Recording::Entry& entry) {
  const std::uint8_t level = level_of(entry.event);
  if (level == 0) return std::nullopt;
  const RosTime time = ros_time(entry.event.time_ns);
  const std::uint32_t line = 0;
  std::vector<std::byte> message;
  ros2::CdrWriter writer(message);
  writer.number(&time.sec, sizeof time.sec);
  writer.number(&time.nanosec, sizeof time.nanosec);
  writer.number(&level, sizeof level);
  writer.text(subsystem_of(recording, entry.event));
  writer.text(log_text(entry));
  writer.text("");
  writer.text("");
  writer.number(&line, sizeof line);
  writer.finish();
  return std::string(reinterpret_cast<const char*>(message.data()), message.size());
}

}  // namespace tessera::bag
