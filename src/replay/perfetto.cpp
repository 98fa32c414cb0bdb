#include "replay/perfetto.hpp"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "replay/timeline.hpp"
#include "replay/values.hpp"
#include "tessera/transition_role.hpp"

namespace tessera::replay {
namespace {

[[nodiscard]] const char* category_of(Event::Kind kind) {
  return kind == Event::Kind::fault  ? "fault"
         : kind == Event::Kind::stop ? "stop"
         : kind == Event::Kind::safe ? "safe"
                                     : "log";
}

using nlohmann::json;

/// The row of a subsystem: agents are processes, numbered from 1.
struct TraceRow {
  std::uint32_t process = 0, thread = 0;
};

class Writing {
 public:
  Writing(const Recording& recording, std::ostream& to) : recording_(recording), to_(to) {}

  void run() {
    to_ << "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[";
    name_rows();
    for (const Lane& lane : timeline_of(recording_).lanes) write_lane(lane);
    write_iterations();
    write_log();
    write_values();
    to_ << "\n]}\n";
  }

 private:
  void write(const json& event) {
    to_ << (first_ ? "\n" : ",\n") << event.dump(-1, ' ', false, json::error_handler_t::replace);
    first_ = false;
  }

  void name_rows() {
    std::map<std::string, std::uint32_t> processes;
    for (std::size_t index = 0; index < recording_.instances.size(); ++index) {
      const std::string& path = recording_.instances[index];
      const std::string agent = path.substr(0, path.rfind('.'));
      const auto number = static_cast<std::uint32_t>(processes.size() + 1);
      const auto [process, added] = processes.emplace(agent, number);
      if (added) name("process_name", {process->second, 0}, agent);
      const TraceRow row{process->second, static_cast<std::uint32_t>(index + 1)};
      name("thread_name", row, path.substr(path.rfind('.') + 1));
      rows_.emplace(path, row);
    }
    name("process_name", {0, 0}, recording_.system);
  }

  void name(const char* what, TraceRow row, const std::string& text) {
    write(
        {{"ph", "M"}, {"name", what}, {"pid", row.process}, {"tid", row.thread}, {"args", {{"name", text}}}});
  }

  void slice(const std::string& name, const char* category, TraceRow row, double from_us, double to_us) {
    write({{"ph", "X"},
           {"name", name},
           {"cat", category},
           {"pid", row.process},
           {"tid", row.thread},
           {"ts", from_us},
           {"dur", to_us - from_us}});
  }

  void write_lane(const Lane& lane) {
    for (const auto& [behaviour, from_s, to_s] : lane.stretches)
      slice(lane.behaviours[behaviour], "behaviour", rows_.at(lane.path), from_s * 1e6, to_s * 1e6);
  }

  /// From the first transition of a behaviour to its t4, t5 or t6.
  void write_iterations() {
    std::vector<std::optional<double>> begun(recording_.instances.size());
    for (const auto& [event, text] : recording_.entries) {
      if (event.kind() != Event::Kind::firing || event.instance() >= begun.size()) continue;
      const std::string& path = recording_.instances[event.instance()];
      const TransitionRole& role = recording_.transitions[event.subject].role;
      const double at_us = static_cast<double>(event.time_ns) * 1e-3;
      std::optional<double>& since_us = begun[event.instance()];
      if (!since_us && (role.step == Step::begin_sending || role.step == Step::begin_receiving))
        since_us = at_us;
      if (!role.ends_iteration()) continue;
      const bool failed = role.step == Step::error;
      slice(failed ? "iteration (error)" : "iteration", "iteration", rows_.at(path), since_us.value_or(0),
            at_us);
      since_us.reset();
    }
  }

  void write_log() {
    for (const auto& [event, text] : recording_.entries) {
      if (!event.has_text() || event.kind() == Event::Kind::value || event.kind() == Event::Kind::marking ||
          event.kind() == Event::Kind::poses)
        continue;
      const bool of_subsystem = event.instance() < recording_.instances.size();
      const TraceRow row = of_subsystem ? rows_.at(recording_.instances[event.instance()]) : TraceRow{};
      write({{"ph", "i"},
             {"name", text},
             {"cat", category_of(event.kind())},
             {"pid", row.process},
             {"tid", row.thread},
             {"ts", static_cast<double>(event.time_ns) * 1e-3},
             {"s", of_subsystem ? "t" : "g"}});
    }
  }

  /// Every number and bool of what subsystems read and make, as a counter of its agent.
  void write_values() {
    ValueTrack values(recording_);
    for (const Recording::Entry& entry : recording_.entries) {
      const auto change = values.follow(entry);
      if (!change || change->hashed || change->layout == nullptr) continue;
      const double at_us = static_cast<double>(entry.event.time_ns) * 1e-3;
      const std::string agent = change->buffer.path.substr(0, change->buffer.path.find('.'));
      const std::string name = change->buffer.path.substr(agent.size() + 1);
      const TraceRow row = rows_.at(recording_.instances[change->buffer.instance]);
      std::size_t shown = 0;
      const auto count = [&](const std::string& path, double value) {
        if (!std::isfinite(value) || ++shown > most_counters) return;
        write({{"ph", "C"},
               {"name", path.empty() ? name : name + (path.front() == '[' ? "" : ".") + path},
               {"pid", row.process},
               {"ts", at_us},
               {"args", {{"value", value}}}});
      };
      static_cast<void>(change->layout->visit(
          change->bytes,
          [&](const std::string& path, const auto& scalar) {
            if (scalar.kind != ValueLayout::ScalarValue::Kind::text) count(path, scalar.number);
          },
          [&](const std::string& path, std::size_t length) {
            count(length_path(path), static_cast<double>(length));
          }));
    }
  }
  static constexpr std::size_t most_counters = 16;  // per buffer: the curves of an image are not useful

  const Recording& recording_;
  std::ostream& to_;
  std::map<std::string, TraceRow> rows_;
  bool first_ = true;
};

}  // namespace

void write_perfetto(const Recording& recording, std::ostream& to) { Writing(recording, to).run(); }

}  // namespace tessera::replay
