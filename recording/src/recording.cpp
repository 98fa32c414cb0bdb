#include "tessera/recording.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "recording_header.hpp"
#include "segment_field.hpp"

namespace tessera {
namespace {

constexpr std::uint32_t buffer_shift = 24, buffer_bits = (1U << buffer_shift) - 1;

/// The least number of bytes of a value event with these flags.
[[nodiscard]] std::size_t fixed_bytes(std::uint32_t flags) {
  return ((flags & ValueFlags::stamped) != 0 ? sizeof(std::int64_t) : 0) +
         ((flags & ValueFlags::hashed) != 0 ? 2 * sizeof(std::uint64_t) : 0);
}

/// bytes: the first eight, or fewer. nullopt: none so far.
[[nodiscard]] std::optional<Problem> problem_of_magic(std::string_view bytes) {
  const std::string_view name = recording_magic.substr(0, recording_magic.size() - 1);
  if (!bytes.starts_with(name.substr(0, bytes.size()))) return Problem{"is no recording of Tessera"};
  if (bytes.size() < recording_magic.size() || bytes == recording_magic) return std::nullopt;
  const bool is_newer = bytes.back() > recording_magic.back() && bytes.back() <= '9';
  return Problem{is_newer ? "was recorded by a newer version of Tessera, which has to read it"
                          : "is no recording of Tessera"};
}

[[nodiscard]] bool makes_sense(const Event& event, const Recording& recording) {
  if (event.instance() != system_instance && event.instance() >= recording.instances.size()) return false;
  switch (event.kind()) {
    case Event::Kind::firing:
      return event.subject < recording.transitions.size();
    case Event::Kind::log:
    case Event::Kind::stop:
    case Event::Kind::overrun:
    case Event::Kind::marking:
    case Event::Kind::end:
    case Event::Kind::safe:
    case Event::Kind::parameter:
    case Event::Kind::peer:
    case Event::Kind::process:
      return true;
    case Event::Kind::call:
      return event.instance() < recording.behaviours.size() &&
             event.subject < recording.behaviours[event.instance()].size();
    case Event::Kind::value:
      return (event.version & buffer_bits) < recording.buffers.size() &&
             recording.buffers[event.version & buffer_bits].instance == event.instance() &&
             event.subject >= fixed_bytes(event.version >> buffer_shift);
    case Event::Kind::poses:
      return recording.scene && event.instance() == system_instance;
    case Event::Kind::fault:
      return !name_of(event.fault()).empty() && event.version < 2 * told_fault;
  }
  return false;
}

}  // namespace

bool is_scene_hash(std::string_view text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::string scene_file(const std::string& recording, const std::string& hash) {
  return (std::filesystem::path(recording).parent_path() / (hash + ".glb")).string();
}

void RecordingReader::feed(std::string_view bytes) {
  if (state_ == State::damaged) return;
  // Bytes are copied only if a piece ends within an entry.
  if (!pending_.empty()) {
    pending_.append(bytes);
    bytes = pending_;
  }
  std::size_t taken = state_ == State::header ? take_header(bytes) : 0;
  if (state_ == State::events) taken += take_events(bytes.substr(taken));
  pending_ = std::string(bytes.substr(std::min(taken, bytes.size())));
}

void RecordingReader::give_up(std::string problem) {
  problem_ = Problem{std::move(problem)};
  state_ = State::damaged;
}

/// 0: the header is not complete yet.
std::size_t RecordingReader::take_header(std::string_view bytes) {
  std::uint32_t length = 0;
  const std::size_t before_header = recording_magic.size() + sizeof length;
  if (const std::optional<Problem> problem = problem_of_magic(bytes.substr(0, recording_magic.size()))) {
    give_up(problem->text);
    return 0;
  }
  if (bytes.size() < before_header) return 0;
  std::memcpy(&length, bytes.data() + recording_magic.size(), sizeof length);
  if (length > longest_recording_header) give_up("has a damaged header");
  const std::size_t start_of_events = (before_header + length + 7) / 8 * 8;
  if (state_ == State::damaged || bytes.size() < start_of_events) return 0;
  recording_.header = bytes.substr(before_header, length);
  if (!read_header(recording_)) {
    give_up("has a damaged header");
    return 0;
  }
  state_ = State::events;
  has_header_ = true;
  return start_of_events;
}

std::size_t RecordingReader::take_events(std::string_view bytes) {
  const std::size_t size = bytes.size();
  while (bytes.size() >= sizeof(Event)) {
    Recording::Entry entry;
    std::memcpy(&entry.event, bytes.data(), sizeof(Event));
    if (!makes_sense(entry.event, recording_)) {
      give_up("is damaged");
      break;
    }
    has_ended_ = entry.event.kind() == Event::Kind::end;
    if (has_ended_) {
      recording_.lost += entry.event.subject;
      bytes.remove_prefix(sizeof(Event));
      continue;
    }
    std::size_t padded = 0;
    if (entry.event.has_text()) {
      const std::size_t length = entry.event.subject;
      padded = (length + sizeof(Event) - 1) / sizeof(Event) * sizeof(Event);
      if (padded > bytes.size() - sizeof(Event)) break;
      entry.text = bytes.substr(sizeof(Event), length);
    }
    bytes.remove_prefix(sizeof(Event) + padded);
    recording_.entries.push_back(std::move(entry));
  }
  return size - bytes.size();
}

std::string_view name_of(Fault fault) {
  switch (fault) {
    case Fault::net:
      return "net";
    case Fault::assertion:
      return "assertion";
    case Fault::exception:
      return "exception";
    case Fault::not_finite:
      return "not finite";
    case Fault::device:
      return "device";
    case Fault::stale:
      return "stale";
    case Fault::stall:
      return "stall";
    case Fault::overrun:
      return "overrun";
    case Fault::crash:
      return "crash";
    case Fault::limit:
      return "limit";
    case Fault::overtime:
      return "overtime";
  }
  return "";
}

std::string_view name_of(Event::Kind kind) {
  switch (kind) {
    case Event::Kind::firing:
      return "firing";
    case Event::Kind::log:
      return "log";
    case Event::Kind::stop:
      return "stop";
    case Event::Kind::fault:
      return "fault";
    case Event::Kind::overrun:
      return "overrun";
    case Event::Kind::call:
      return "call";
    case Event::Kind::value:
      return "value";
    case Event::Kind::marking:
      return "marking";
    case Event::Kind::end:
      return "end";
    case Event::Kind::safe:
      return "safe";
    case Event::Kind::parameter:
      return "parameter";
    case Event::Kind::poses:
      return "poses";
    case Event::Kind::peer:
      return "peer";
    case Event::Kind::process:
      return "process";
  }
  return {};
}

std::string_view name_of(Recording::Direction direction) {
  constexpr std::string_view names[] = {"in", "out", "real_in", "real_out", "memory"};
  return names[static_cast<std::size_t>(direction)];
}

ValueEvent value_of(const Recording::Entry& entry) {
  ValueEvent value{.buffer = entry.event.version & buffer_bits,
                   .flags = entry.event.version >> buffer_shift,
                   .bytes = entry.text};
  if (value.has(ValueFlags::stamped)) {
    std::memcpy(&value.stamp_ns, entry.text.data(), sizeof value.stamp_ns);
    value.bytes.remove_prefix(sizeof value.stamp_ns);
  }
  return value;
}

namespace {

[[nodiscard]] std::optional<Recording> read_segment(const std::string& path, std::string& error) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream whole;
  whole << file.rdbuf();  // in blocks
  const std::string content = std::move(whole).str();
  if (!file.is_open() || whole.bad()) {
    error = fmt::format("cannot read '{}'", path);
    return std::nullopt;
  }
  RecordingReader reader;
  reader.feed(content);
  const bool cut = !reader.has_header() && !reader.problem();
  if (cut && content.size() >= 12) reader.feed(std::string(7, '\0'));  // ends the padding after the header
  if (!reader.has_header()) {
    const bool begins_well = content.size() >= 12 && !reader.problem();
    error = fmt::format("'{}' {}", path,
                        begins_well        ? "has a damaged header"
                        : reader.problem() ? reader.problem()->text
                                           : "is no recording of Tessera");
    return std::nullopt;
  }
  reader.recording().truncated = reader.problem() || !reader.has_ended() || reader.pending() > 0;
  return std::move(reader.recording());
}

/// Precondition: at least one segment. The newest comes first.
[[nodiscard]] Recording joined(std::vector<Recording> segments) {
  Recording all = std::move(segments.back());
  for (segments.pop_back(); !segments.empty(); segments.pop_back()) {
    Recording& next = segments.back();
    std::move(next.entries.begin(), next.entries.end(), std::back_inserter(all.entries));
    all.truncated = all.truncated || next.truncated;
    all.lost += next.lost;
  }
  return all;
}

/// One more than the number of the newest segment beside the file; 0: there is none. The file itself may be
/// missing or have no header, if the controller was killed or the disk was full while the file was begun.
[[nodiscard]] std::uint64_t after_newest_number(const std::string& file) {
  const std::filesystem::path whole(file);
  std::error_code ignored;
  std::uint64_t after = 0;
  const std::filesystem::path folder = whole.has_parent_path() ? whole.parent_path() : ".";
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string path = entry.path().string();
    if (std::filesystem::path(without_segment_number(path)).filename() != whole.filename()) continue;
    const std::string digits = entry.path().stem().extension().string().substr(1);
    std::uint64_t number = 0;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), number).ec == std::errc{})
      after = std::max(after, number + 1);
  }
  return after;
}

}  // namespace

bool lacks_beginning(const Recording& recording) { return recording.segment.value_or(0) > 0; }

std::string note_on_beginning(const Recording& recording) {
  if (!lacks_beginning(recording)) return "";
  return note_on_lost_beginning(
      recording.entries.empty() ? std::nullopt : std::optional(recording.entries.front().event.time_ns));
}

std::string note_on_lost_beginning(std::optional<std::int64_t> from_ns) {
  const std::string held =
      from_ns ? fmt::format("what happened from {:.3f} s on", static_cast<double>(*from_ns) * 1e-9)
              : std::string("no event that is whole");
  return fmt::format("its beginning is gone: it holds {}; a run with --record-limit none keeps everything",
                     held);
}

FileEnd end_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Event last;
  if (!file.seekg(-static_cast<std::streamoff>(sizeof last), std::ios::end) ||
      !file.read(reinterpret_cast<char*>(&last), sizeof last) || last.kind() != Event::Kind::end)
    return FileEnd::cut;
  return last.version != 0 ? FileEnd::goes_on : FileEnd::final;
}

std::string segment_path(const std::string& path, std::uint64_t number) {
  const std::filesystem::path whole(path);
  return (whole.parent_path() /
          fmt::format("{}.{}{}", whole.stem().string(), number, whole.extension().string()))
      .string();
}

std::string without_segment_number(const std::string& path) {
  const std::filesystem::path whole(path), stem = whole.stem();
  const std::string number = stem.extension().string();
  if (number.size() < 2 || number.find_first_not_of("0123456789", 1) != std::string::npos) return {};
  return (whole.parent_path() / (stem.stem().string() + whole.extension().string())).string();
}

std::optional<std::uint64_t> segment_number_in(const std::string& file) {
  std::ifstream bytes(file, std::ios::binary);
  std::string start(recording_magic.size() + sizeof(std::uint32_t), '\0');
  if (!bytes.read(start.data(), static_cast<std::streamsize>(start.size())) ||
      !start.starts_with(recording_magic))
    return std::nullopt;
  std::uint32_t length = 0;
  std::memcpy(&length, start.data() + recording_magic.size(), sizeof length);
  if (length > longest_recording_header) return std::nullopt;
  std::string header(length, '\0');
  if (!bytes.read(header.data(), length)) return std::nullopt;
  return segment_in(header);
}

std::optional<Recording> read_recording(const std::string& path, std::string& error) {
  const bool folder = std::filesystem::is_directory(path);
  const std::string file = folder ? (std::filesystem::path(path) / recording_file_name).string() : path;
  std::optional<Recording> newest = read_segment(file, error);
  if (newest && (!newest->segment || !without_segment_number(file).empty())) return newest;
  // A full file: the controller was killed before it began the next one.
  const bool newest_is_missing = !newest || end_of(file) == FileEnd::goes_on;
  std::uint64_t number = newest ? *newest->segment : after_newest_number(file);
  std::vector<Recording> segments;
  if (newest) segments.push_back(std::move(*newest));
  while (number > 0) {
    std::string none;
    std::optional<Recording> before = read_segment(segment_path(file, --number), none);
    if (!before ||
        (!segments.empty() && without_segment(before->header) != without_segment(segments.front().header)))
      break;
    segments.push_back(std::move(*before));
  }
  if (segments.empty()) return std::nullopt;
  Recording all = joined(std::move(segments));
  all.truncated = all.truncated || newest_is_missing;
  return all;
}

}  // namespace tessera
