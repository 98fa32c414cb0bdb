#include "replay/events.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <map>
#include <vector>

#include "replay/values.hpp"
#include "tessera/printable.hpp"

namespace tessera::replay {
namespace {

using Entry = Recording::Entry;

std::string path_of(const Recording& recording, const Event& event) {
  return event.instance() < recording.instances.size() ? recording.instances[event.instance()] : "system";
}

/// The text of an event that is not a value.
std::string text_of(const Recording& recording, const Entry& entry) {
  const Event& event = entry.event;
  switch (event.kind()) {
    case Event::Kind::firing:
      return recording.transitions[event.subject].name;
    case Event::Kind::overrun:
      return fmt::format("{} instants of its rate missed", event.subject);
    case Event::Kind::marking:
      return fmt::format("a segment of the recording begins; {} places hold a token",
                         std::ranges::count(entry.text, '\n') + (entry.text.empty() ? 0 : 1));
    case Event::Kind::peer: {
      const std::size_t line = std::min(entry.text.find('\n'), entry.text.size());
      const std::string start = entry.text.substr(std::min(line + 1, entry.text.size()));
      return fmt::format("{}: hears start {} of the other process", entry.text.substr(0, line), start);
    }
    case Event::Kind::process: {
      const std::size_t line = std::min(entry.text.find('\n'), entry.text.size());
      const std::string start = entry.text.substr(std::min(line + 1, entry.text.size()));
      return fmt::format("process {} {} (start {})", entry.text.substr(0, line),
                         event.version == 0 ? "has died" : "begins again", start);
    }
    case Event::Kind::call:
      return fmt::format("{}, iteration {}", recording.behaviours[event.instance()][event.subject],
                         event.version);
    default:
      return entry.text;
  }
}

/// In front of the text of an event.
std::string prefix_of(const Event& event) {
  switch (event.kind()) {
    case Event::Kind::firing:
    case Event::Kind::log:
    case Event::Kind::value:
    case Event::Kind::marking:
    case Event::Kind::end:
    case Event::Kind::safe:
    case Event::Kind::poses:
    case Event::Kind::peer:
    case Event::Kind::process:
      return "";
    case Event::Kind::stop:
      return "stop: ";
    case Event::Kind::parameter:
      return "parameter: ";
    case Event::Kind::overrun:
      return "overrun: ";
    case Event::Kind::call:
      return "calls ";
    case Event::Kind::fault:
      return fmt::format("fault ({}): ", name_of(event.fault()));
  }
  return "";
}

struct Row {
  Event event;
  std::string text;  ///< as it is printed
};

/// The rows that `make` makes of the selected events, in the order of their times.
std::vector<Row> rows_of(const Recording& recording, const Selection& selection,
                         const std::function<std::string(const Entry&, const std::string& text,
                                                         const ValueTrack::Change*)>& make) {
  ValueTrack values(recording);
  std::vector<Row> rows;
  for (const Entry& entry : recording.entries) {
    if (!is_listed(entry)) continue;
    const auto change = values.follow(entry);
    if (change ? !selection.values || change->buffer.path.find(*selection.values) == std::string::npos
               : !selection.events)
      continue;
    const double at_s = static_cast<double>(entry.event.time_ns) * 1e-9;
    if (at_s < selection.from_s || at_s > selection.to_s) continue;
    if (!selection.subsystem.empty() && path_of(recording, entry.event) != selection.subsystem) continue;
    const std::string text =
        change ? fmt::format("{} = {}", change->buffer.path, text_of(*change)) : text_of(recording, entry);
    if (text.find(selection.containing) == std::string::npos) continue;
    rows.push_back({entry.event, make(entry, text, change ? &*change : nullptr)});
  }
  std::ranges::stable_sort(rows, {}, [](const Row& row) { return row.event.time_ns; });
  if (selection.last > 0 && rows.size() > selection.last)
    rows.erase(rows.begin(), rows.end() - static_cast<std::ptrdiff_t>(selection.last));
  return rows;
}

std::string quoted_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

// ---------------------------------------------------------------------------------------------- values

/// The columns of all fields of the selected buffers.
class Columns {
 public:
  Columns(const Recording& recording, const std::string& filter) {
    for (const Recording::Buffer& buffer : recording.buffers) {
      if (buffer.path.find(filter) == std::string::npos) continue;
      const auto layout = ValueLayout::parse(buffer.type);
      if (!layout) continue;
      for (const std::string& path : layout->sequences()) add(length_path(path));
      for (const std::string& path : layout->paths()) add(name(path));
    }
  }
  [[nodiscard]] std::string head() const {
    std::string text;
    for (const std::string& column : names_) text += ',' + quoted_field(column);
    return text;
  }
  [[nodiscard]] std::string row(const ValueTrack::Change& change) const {
    std::vector<std::string> cells(names_.size());
    if (!change.hashed && change.layout != nullptr)
      static_cast<void>(change.layout->visit(
          change.bytes,
          [&](const std::string& path, const auto& scalar) { put(cells, name(path), scalar.shown()); },
          [&](const std::string& path, std::size_t length) {
            put(cells, length_path(path), std::to_string(length));
          }));
    std::string text;
    for (const std::string& cell : cells) text += ',' + cell;
    return text;
  }

 private:
  static constexpr std::size_t most_elements = 16;
  void add(const std::string& name) {
    if (wanted(name) && columns_.emplace(name, names_.size()).second) names_.push_back(name);
  }
  void put(std::vector<std::string>& cells, const std::string& name, const std::string& text) const {
    if (const auto column = columns_.find(name); column != columns_.end())
      cells[column->second] = quoted_field(text);
  }
  static std::string name(const std::string& path) { return path.empty() ? "value" : path; }
  static bool wanted(const std::string& path) {
    for (std::size_t at = path.find('['); at != std::string::npos; at = path.find('[', at + 1))
      if (std::stoull(path.substr(at + 1)) >= most_elements) return false;
    return true;
  }
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> columns_;
};

const char* status_of(const ValueTrack::Change& change) {
  if (change.event.has(ValueFlags::silent)) return "no value";
  if (change.event.has(ValueFlags::failed)) return "failed";
  const bool invalid = change.event.has(ValueFlags::stamped) && !change.event.has(ValueFlags::valid);
  return invalid ? "invalid" : "";
}

}  // namespace

void print_events(const Recording& recording, const Selection& selection, std::ostream& to) {
  const auto line = [&](const Entry& entry, const std::string& text, const ValueTrack::Change* change) {
    const Event& event = entry.event;
    const bool named = event.kind() == Event::Kind::firing || change != nullptr;
    return fmt::format("{:14.6f} {}{}{}{}\n", static_cast<double>(event.time_ns) * 1e-9,
                       named ? "" : path_of(recording, event) + ": ", prefix_of(event), text,
                       event.kind() == Event::Kind::firing && event.version != 0
                           ? fmt::format("  (version {})", event.version)
                           : "");
  };
  for (const Row& row : rows_of(recording, selection, line)) to << printable(row.text);
}

void write_csv(const Recording& recording, const Selection& selection, std::ostream& to) {
  to << "time_ns,sequence,kind,subsystem,version,text\n";
  const auto line = [&](const Entry& entry, const std::string& text, const ValueTrack::Change* change) {
    const Event& event = entry.event;
    return fmt::format("{},{},{},{},{},{}\n", event.time_ns, event.sequence, name_of(event.kind()),
                       quoted_field(path_of(recording, event)),
                       change == nullptr ? event.version : change->event.flags, quoted_field(text));
  };
  for (const Row& row : rows_of(recording, selection, line)) to << row.text;
}

void write_values_csv(const Recording& recording, const Selection& selection, std::ostream& to) {
  Selection values = selection;
  values.events = false;
  const Columns columns(recording, values.values.value_or(""));
  to << "time_ns,buffer,status,stamp_ns" << columns.head() << '\n';
  const auto line = [&](const Entry& entry, const std::string&, const ValueTrack::Change* change) {
    return fmt::format("{},{},{},{}{}\n", entry.event.time_ns, quoted_field(change->buffer.path),
                       status_of(*change),
                       change->event.has(ValueFlags::stamped) ? std::to_string(change->event.stamp_ns) : "",
                       columns.row(*change));
  };
  for (const Row& row : rows_of(recording, values, line)) to << row.text;
}

}  // namespace tessera::replay
