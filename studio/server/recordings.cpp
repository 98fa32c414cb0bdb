#include "server/recordings.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "replay/values.hpp"
#include "server/growing_file.hpp"
#include "server/json_text.hpp"
#include "server/path.hpp"
#include "server/tail.hpp"
#include "server/value_json.hpp"
#include "tessera/recording.hpp"

namespace tessera::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr const char* recording_of_a_run = "recording.tsr";

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

/// Header and last event; null: it is none.
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
  /// The next segment, whose entries come now.
  void begin(const Recording& header) { track_.emplace(header); }

  void add(const Recording::Entry& entry, bool shown) {
    const std::optional<replay::ValueTrack::Change> change =
        track_->follow(entry);  // those before the span, too
    if (!change || !shown || change->hashed || change->layout == nullptr || change->bytes.empty()) return;
    if (change->layout->scalars() > most_scalars) return;
    static_cast<void>(
        change->layout->visit(change->bytes, [&](const std::string& path, const ValueLayout::Scalar& scalar) {
          if (++samples_ > Recordings::most_samples) return;
          const std::string dot = path.empty() || path.front() == '[' ? "" : ".";
          series_[change->buffer.path + dot + path].push_back({entry.event.time_ns, json_of(scalar)});
        }));
  }
  [[nodiscard]] bool complete() const { return samples_ <= Recordings::most_samples; }
  [[nodiscard]] json take() { return std::move(series_); }

 private:
  static constexpr std::size_t most_scalars = 16;  // of a value: longer lists are no curves

  std::optional<replay::ValueTrack> track_;
  std::size_t samples_ = 0;
  json series_ = json::object();
};

/// What is shown of a recording.
class Content {
 public:
  /// net: that the indices are of; nullptr: there is none.
  Content(const net::Net* net, Recordings::Span span) : span_(span) {
    if (net != nullptr) names_.emplace(*net);
  }

  void begin(const Recording& recording) {
    values_.begin(recording);
    transitions_ = names_ ? names_->transitions_of(recording) : std::vector<std::uint32_t>();
    if (!content_.is_null()) return;
    content_ = {{"net_hash", recording.net_hash},
                {"system", recording.system},
                {"subsystems", recording.instances},
                {"marking", nullptr}};
    is_ordered_ = recording.clock == "simulated";
    // The first that is left, but not the first of the run; its marking follows.
    if (recording.segment.value_or(0) > 0) content_["marking"] = json::array();
  }

  void add(const Recording::Entry& entry) {
    const Event& event = entry.event;
    const bool shown = event.time_ns >= span_.from_ns && event.time_ns <= span_.to_ns;
    if (event.kind() == Event::Kind::marking && names_ && std::exchange(awaits_marking_, false) &&
        content_["marking"].is_array())
      content_["marking"] = names_->marked(entry.text);
    if (event.kind() == Event::Kind::value) values_.add(entry, shown);
    if (event.kind() != Event::Kind::firing || !shown) return;
    const bool known = event.subject < transitions_.size() && transitions_[event.subject] != UINT32_MAX;
    if (known && firings_.size() < Recordings::most_firings)
      firings_.emplace_back(event.time_ns, transitions_[event.subject]);
    else
      ++dropped_;
  }

  [[nodiscard]] json take(bool is_cut) {
    // Threads write one after the other; who watches wants the order of time.
    if (!is_ordered_) std::ranges::stable_sort(firings_, {}, &decltype(firings_)::value_type::first);
    content_["firings"] = std::move(firings_);
    content_["dropped"] = dropped_;
    content_["truncated"] = dropped_ > 0 || !values_.complete() || is_cut;
    content_["values"] = values_.take();
    return std::move(content_);
  }

 private:
  const Recordings::Span span_;
  std::optional<NetNames> names_;
  std::vector<std::uint32_t> transitions_;  // of the recording: indices of the net
  ValueSeries values_;
  std::vector<std::pair<std::int64_t, std::uint32_t>> firings_;
  std::uint64_t dropped_ = 0;
  bool is_ordered_ = true, awaits_marking_ = true;
  json content_;
};

json path_of(const fs::path& file, Recordings::Span span) {
  GrowingFile bytes(file);
  PathReader reader;
  ThinPath path(Recordings::most_points);
  for (std::string some; !(some = bytes.more()).empty();)
    for (const PathPoint& point : reader.feed(some))
      if (point.time_ns >= span.from_ns && point.time_ns <= span.to_ns) path.add(point);
  return path.rows();
}

/// The name of the track of a run, from its summary; null: there was none, or it is not known.
json track_of(const fs::path& summary) {
  const json read = json::parse(GrowingFile(summary).more(), nullptr, /*allow_exceptions=*/false);
  const json track = read.is_object() ? read.value("track", json()) : json();
  return track.is_string() ? json(fs::path(track.get<std::string>()).filename().string()) : json();
}

}  // namespace

std::map<std::string, fs::path> Recordings::files() const {
  std::map<std::string, fs::path> found;
  const fs::path folder = file_.folder(), kept = folder / ".tessera";
  const auto add = [&](const std::string& name, const fs::path& file) {
    if (is_plain(file, fs::file_type::regular)) found.emplace(name, file);
  };
  for (const fs::path& file : entries_of(folder)) {
    const std::string whole = without_segment_number(file.string());
    const bool is_part = !whole.empty() && is_plain(whole, fs::file_type::regular);
    if (file.extension() == ".tsr" && !is_part) add(file.filename().string(), file);
  }
  if (!is_plain(kept, fs::file_type::directory)) return found;
  if (is_plain(kept / "last", fs::file_type::directory)) add("last", kept / "last" / recording_of_a_run);
  for (const fs::path& run : entries_of(kept / "runs"))
    if (is_plain(run, fs::file_type::directory)) add(run.filename().string(), run / recording_of_a_run);
  return found;
}

std::string Recordings::list() const {
  json list = json::array();
  for (const auto& [name, file] : files()) {
    struct stat status {};
    if (lstat(file.c_str(), &status) != 0) continue;
    json one = summary_of(file);
    if (one.is_null()) continue;
    one["name"] = name;
    one["modified"] =
        static_cast<std::int64_t>(status.st_mtim.tv_sec) * 1000 + status.st_mtim.tv_nsec / 1'000'000;
    list.push_back(std::move(one));
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const json& one, const json& other) { return one["modified"] > other["modified"]; });
  return text_of(list);
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
  const bool has_files = file.filename() == recording_of_a_run;  // beside it
  whole["path"] = has_files ? path_of(file.parent_path() / "path.csv", span) : json::array();
  whole["track"] = has_files ? track_of(file.parent_path() / "summary.json") : json();
  return text_of(whole);
}

}  // namespace tessera::server
