#include "server/recordings/recordings.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "project/files/file_names.hpp"
#include "project/files/state_folder.hpp"
#include "replay/values.hpp"
#include "server/http/json_text.hpp"
#include "server/recordings/growing_file.hpp"
#include "server/recordings/marking_tracker.hpp"
#include "server/recordings/notices.hpp"
#include "server/recordings/pose_track.hpp"
#include "server/recordings/recording_tail.hpp"
#include "server/recordings/robot_path.hpp"
#include "server/recordings/value_json.hpp"
#include "tessera/recording.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

bool is_plain(const fs::path& path, fs::file_type type) {
  std::error_code ignored;
  return fs::symlink_status(path, ignored).type() == type;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code ignored;
  if (!is_plain(folder, fs::file_type::directory)) return entries;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end; entry.increment(ignored))
    entries.push_back(entry->path());
  return entries;
}

RecordingStream stream_of(const fs::path& file) {
  return RecordingStream(RecordingStream::of_file(file, GrowingRecording::From::oldest));
}

/// The header and the last event; null: the file is no recording.
json summary_of(const fs::path& file) {
  RecordingStream stream = stream_of(file);
  json summary;
  std::int64_t last_ns = 0;
  while (stream.next()) {
    const std::shared_ptr<const Recording>& recording = stream.recording();
    if (!recording) continue;
    if (summary.is_null())
      summary = {
          {"system", recording->system}, {"net_hash", recording->net_hash}, {"clock", recording->clock}};
    for (const Recording::Entry& entry : recording->entries) last_ns = std::max(last_ns, entry.event.time_ns);
  }
  if (summary.is_null()) return summary;
  summary["duration"] = static_cast<double>(last_ns) * 1e-9;
  summary["bytes"] = stream.bytes();
  return summary;
}

/// The values of a recording by path, "robot.sensor.line.left": [[t, value]...], as the page plots them.
class ValueSeries {
 public:
  /// Begins the next segment, whose entries follow.
  void begin(const Recording& header, Recordings::Span span) {
    show_what_was(span.from_ns);
    recording_ = &header;
    track_.emplace(header);
  }

  /// The last values before the span are shown at its beginning.
  void add(const Recording::Entry& entry, Recordings::Span span) {
    const std::int64_t time_ns = entry.event.time_ns;
    if (time_ns >= span.from_ns) show_what_was(span.from_ns);
    const std::optional<replay::ValueTrack::Change> change = track_->follow(entry);
    if (!change || time_ns > span.to_ns) return;
    const bool lost = change->event.has(ValueFlags::silent | ValueFlags::failed);
    if (time_ns >= span.from_ns) arrived(*change, time_ns);
    if (lost)
      lose(change->number, std::max(time_ns, span.from_ns));
    else if (time_ns < span.from_ns)
      before_.insert(change->number);
    else
      show(change->number, time_ns);
  }
  void show_what_was(std::int64_t time_ns) {
    for (const std::uint32_t buffer : std::exchange(before_, {})) show(buffer, time_ns);
  }
  [[nodiscard]] bool complete() const { return samples_ <= Recordings::most_samples; }
  [[nodiscard]] json take() { return std::move(series_); }
  /// When the inputs got values of their senders: {"robot.control.line": [[t, written, valid]...]}
  [[nodiscard]] json take_arrivals() { return std::move(arrivals_); }

 private:
  static constexpr std::size_t most_scalars = 16;  // per value: longer lists get no curves

  void arrived(const replay::ValueTrack::Change& change, std::int64_t time_ns) {
    const ValueEvent& event = change.event;
    if (!event.has(ValueFlags::stamped)) return;
    const bool valid = event.has(ValueFlags::valid);
    // Only the first read of an input that holds no valid value says something.
    const bool begins_invalid = !valid && invalid_.insert(change.number).second;
    if (valid) invalid_.erase(change.number);
    if (!event.has(ValueFlags::fresh) && !begins_invalid) return;
    if (++samples_ > Recordings::most_samples) return;
    arrivals_[change.buffer.path].push_back({time_ns, event.stamp_ns, event.has(ValueFlags::valid)});
  }
  /// The device gives no value from then on: its curves have a gap.
  void lose(std::uint32_t buffer, std::int64_t time_ns) {
    before_.erase(buffer);
    for (const std::string& path : paths_[buffer]) {
      if (++samples_ > Recordings::most_samples) return;
      series_[path].push_back({time_ns, nullptr});
    }
  }

  void show(std::uint32_t buffer, std::int64_t time_ns) {
    const replay::ValueTrack::Value value = track_->value(buffer);
    if (value.hashed || value.layout == nullptr || value.bytes.empty()) return;
    if (value.layout->scalars() > most_scalars) return;
    static_cast<void>(value.layout->visit(
        value.bytes,
        [&](const std::string& path, const ValueLayout::ScalarValue& scalar) {
          if (++samples_ > Recordings::most_samples) return;
          const std::string dot = path.empty() || path.front() == '[' ? "" : ".";
          const std::string whole = recording_->buffers[buffer].path + dot + path;
          paths_[buffer].insert(whole);
          series_[whole].push_back({time_ns, json_of(scalar)});
        },
        [&](const std::string& path, std::size_t length) {
          if (++samples_ > Recordings::most_samples) return;
          series_[recording_->buffers[buffer].path + "." + replay::length_path(path)].push_back(
              {time_ns, length});
        }));
  }

  const Recording* recording_ = nullptr;
  std::optional<replay::ValueTrack> track_;
  std::set<std::uint32_t> before_;  // buffers that got a value before the span
  std::size_t samples_ = 0;
  json series_ = json::object(), arrivals_ = json::object();
  std::map<std::uint32_t, std::set<std::string>> paths_;  // of the curves of a buffer
  std::set<std::uint32_t> invalid_;                       // inputs that hold no valid value
};

/// The part of a recording that is shown.
class Content {
 public:
  /// net: the net to which the indices refer; nullptr: there is none.
  Content(const net::Net* net, Recordings::Span span) : span_(span) {
    if (net == nullptr) return;
    names_.emplace(*net);
    tokens_.emplace(*net);
  }

  void begin(const Recording& recording) {
    values_.begin(recording, span_);
    header_ = &recording;
    transitions_ = names_ ? names_->transitions_of(recording) : std::vector<net::TransitionId>();
    if (!content_.is_null()) return;
    content_ = {
        {"net_hash", recording.net_hash}, {"system", recording.system}, {"subsystems", recording.instances}};
    poses_.begin(recording);
    content_["scene"] = poses_.scene();
    content_["lacks_beginning"] = lacks_beginning(recording);
    is_ordered_ = recording.clock == "simulated";
    // The first segment that is left, but not the first of the run; its marking follows.
    begins_ = lacks_beginning(recording) ? Begins::unknown : Begins::initial;
  }

  void add(const Recording::Entry& entry) {
    const Event& event = entry.event;
    if (event.kind() == Event::Kind::marking && names_ && std::exchange(awaits_marking_, false) &&
        begins_ == Begins::unknown) {
      tokens_->set(names_->marked(entry.text));
      if (event.version == 0) begins_ = Begins::marked;
    }
    if (event.kind() == Event::Kind::value) values_.add(entry, span_);
    if (event.kind() == Event::Kind::firing) add_firing(event);
    if (std::optional<json> notice = notice_of(*header_, entry)) notices_.add(std::move(*notice));
    if (!poses_.has_one_robot()) return;
    poses_.take(entry);
    if (const auto point = poses_.take_point();
        point && point->time_ns >= span_.from_ns && point->time_ns <= span_.to_ns)
      path_.add(*point);
  }

  [[nodiscard]] json take(bool is_cut) {
    // Threads write one after the other; an observer needs the order of time.
    if (!is_ordered_) std::ranges::stable_sort(firings_, {}, &decltype(firings_)::value_type::first);
    content_["marking"] = marking();
    content_["firings"] = std::move(firings_);
    content_["path"] = rows_of(path_);
    content_["notices"] = notices_.kept();
    content_["first"] = total_ > 0 ? json(first_ns_) : json();
    content_["last"] = total_ > 0 ? json(last_ns_) : json();
    content_["total"] = total_;
    content_["dropped"] = dropped_;
    content_["cut"] = is_cut;
    content_["truncated"] = dropped_ > 0 || !values_.complete() || is_cut;
    values_.show_what_was(span_.from_ns);
    content_["values"] = values_.take();
    content_["arrivals"] = values_.take_arrivals();
    return std::move(content_);
  }

 private:
  enum class Begins : std::uint8_t { initial, marked, unknown };

  void add_firing(const Event& event) {
    first_ns_ = std::min(first_ns_, event.time_ns);
    last_ns_ = std::max(last_ns_, event.time_ns);
    ++total_;
    const bool known = event.subject < transitions_.size() && transitions_[event.subject].valid();
    if (event.time_ns > span_.to_ns) return;
    if (event.time_ns >= span_.from_ns) {
      // If the limit of values is reached, the next part begins.
      if (known && firings_.size() < Recordings::most_firings && values_.complete())
        firings_.emplace_back(event.time_ns, transitions_[event.subject].value);
      else
        ++dropped_;
    } else if (known && begins_ != Begins::unknown) {
      tokens_->fire(transitions_[event.subject]);
      begins_ = Begins::marked;
    }
  }

  /// The marking before the first firing that is shown; null: the initial one, none: it is not known.
  [[nodiscard]] json marking() const {
    if (begins_ == Begins::initial || !tokens_) return nullptr;
    return begins_ == Begins::marked ? json(tokens_->marked()) : json::array();
  }

  const Recordings::Span span_;
  std::optional<NetNames> names_;
  std::optional<MarkingTracker> tokens_;
  std::vector<net::TransitionId> transitions_;  // per transition of the recording: that of the net
  ValueSeries values_;
  PoseTrack poses_;
  const Recording* header_ = nullptr;  // of the segment
  Notices notices_{Recordings::most_notices};
  replay::Thinned<PathPoint> path_{Recordings::most_points};
  std::vector<std::pair<std::int64_t, std::uint32_t>> firings_;
  std::uint64_t dropped_ = 0, total_ = 0;
  std::int64_t first_ns_ = INT64_MAX, last_ns_ = INT64_MIN;
  bool is_ordered_ = true, awaits_marking_ = true;
  Begins begins_ = Begins::initial;
  json content_;
};

/// The name of the track of a run, from its summary; null: there is none, or it is not known.
json track_of(const fs::path& summary) {
  const json read = json::parse(GrowingFile(summary).more(), nullptr, /*allow_exceptions=*/false);
  const json track = read.is_object() ? read.value("track", json()) : json();
  return track.is_string() ? json(fs::path(track.get<std::string>()).filename().string()) : json();
}

}  // namespace

std::map<std::string, fs::path> Recordings::files() const {
  std::map<std::string, fs::path> found;
  const fs::path folder = file_.folder(), kept = project::own_folder(folder);
  const auto add = [&](const std::string& name, const fs::path& file) {
    if (is_plain(file, fs::file_type::regular)) found.emplace(name, file);
  };
  for (const fs::path& file : entries_of(folder)) {
    const std::string whole = without_segment_number(file.string());
    const bool is_part = !whole.empty() && is_plain(whole, fs::file_type::regular);
    if (file.extension() == ".tsr" && !is_part) add(file.filename().string(), file);
  }
  const fs::path state = project::state_folder(folder), elsewhere = state == kept ? fs::path() : state;
  for (const fs::path& root : {kept, elsewhere}) {
    if (root.empty() || !is_plain(root, fs::file_type::directory)) continue;
    for (const fs::path& run : entries_of(root / "runs"))
      if (is_plain(run, fs::file_type::directory))
        add(run.filename().string(), run / project::file_names::recording);
    // A link to one of the runs, or the folder of an earlier version.
    if (is_plain(root / "last", fs::file_type::directory))
      add("last", root / "last" / project::file_names::recording);
  }
  return found;
}

/// The summary with "modified". A recording is read as a whole only if it has changed.
json Recordings::known_summary_of(const fs::path& file) const {
  struct stat status {};
  if (lstat(file.c_str(), &status) != 0) return nullptr;
  const std::int64_t modified_ns =
      std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
  {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(file);
    if (known != known_.end() && known->second.bytes == status.st_size &&
        known->second.modified_ns == modified_ns)
      return known->second.summary;
  }
  json summary = summary_of(file);
  if (!summary.is_null()) summary["modified"] = modified_ns / 1'000'000;
  const std::lock_guard lock(mutex_);
  known_[file] = {status.st_size, modified_ns, summary};
  return summary;
}

std::string Recordings::list() const {
  json list = json::array();
  for (const auto& [name, file] : files()) {
    json one = known_summary_of(file);
    if (one.is_null()) continue;
    one["name"] = name;
    one["notes"] = RecordingNotes::of(file);
    list.push_back(std::move(one));
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const json& one, const json& other) { return one["modified"] > other["modified"]; });
  return text_of(list);
}

std::optional<RecordingNotes::Outcome> Recordings::write_notes(const std::string& name, const Notes& notes,
                                                               const std::string& revision) {
  const auto all = files();
  const auto found = all.find(name);
  if (found == all.end()) return std::nullopt;
  return notes_.write(found->second, notes, revision);
}

std::optional<std::string> Recordings::content(const std::string& name, Span span) const {
  const auto all = files();
  const auto found = all.find(name);
  if (found == all.end()) return std::nullopt;
  const fs::path& file = found->second;
  const std::shared_ptr<const Analysis> analysis = analyses_.of(file_.read().text);
  Content content(analysis->net ? &*analysis->net : nullptr, span);
  RecordingStream stream = stream_of(file);
  while (stream.next()) {
    if (stream.begins()) content.begin(*stream.recording());
    if (stream.recording())
      for (const Recording::Entry& entry : stream.recording()->entries) content.add(entry);
  }
  if (!stream.recording()) throw std::runtime_error(name + " is no recording");
  json whole = content.take(stream.is_cut());
  const bool has_files = file.filename() == project::file_names::recording;  // beside it
  whole["track"] = has_files ? track_of(file.parent_path() / project::file_names::summary) : json();
  return text_of(whole);
}

}  // namespace tessera::server
