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

/// Header and last event, without what is between.
json summary_of(const fs::path& file) {
  constexpr std::size_t most_header = std::size_t{64} << 20U;
  GrowingFile bytes(file);
  RecordingReader reader;
  std::size_t read = 0;
  while (!reader.has_header() && reader.problem().empty() && read < most_header) {
    const std::string some = bytes.more(std::size_t{1} << 18U);
    if (some.empty()) break;
    read += some.size();
    reader.feed(some);
  }
  if (!reader.has_header()) return nullptr;
  json summary{{"system", reader.recording().system},
               {"net_hash", reader.recording().net_hash},
               {"clock", reader.recording().clock},
               {"duration", 0}};
  std::int64_t last_ns = 0;
  for (std::string some; !(some = bytes.more()).empty() || !reader.recording().entries.empty();) {
    for (const Recording::Entry& entry : std::exchange(reader.recording().entries, {}))
      last_ns = std::max(last_ns, entry.event.time_ns);
    reader.feed(some);
  }
  summary["duration"] = static_cast<double>(last_ns) * 1e-9;
  return summary;
}

/// The values of a recording by path, "robot.sensor.line.left": [[t, value]...], as the page plots them.
class ValueSeries {
 public:
  explicit ValueSeries(const Recording& header) : track_(header) {}

  void add(const Recording::Entry& entry, bool shown) {
    const std::optional<replay::ValueTrack::Change> change =
        track_.follow(entry);  // those before the span, too
    if (!change || !shown || change->hashed || change->layout == nullptr || change->bytes.empty()) return;
    if (paths_.size() <= change->number) paths_.resize(change->number + 1);
    std::size_t& scalars = paths_[change->number];
    if (scalars == 0) scalars = change->layout->paths().size();
    if (scalars > most_scalars) return;
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

  replay::ValueTrack track_;
  std::vector<std::size_t> paths_;  // per buffer: how many scalars it has; 0: not known yet
  std::size_t samples_ = 0;
  json series_ = json::object();
};

}  // namespace

std::map<std::string, fs::path> Recordings::files() const {
  std::map<std::string, fs::path> found;
  const fs::path folder = file_.folder(), kept = folder / ".tessera";
  const auto add = [&](const std::string& name, const fs::path& file) {
    if (is_plain(file, fs::file_type::regular)) found.emplace(name, file);
  };
  for (const fs::path& file : entries_of(folder))
    if (file.extension() == ".tsr") add(file.filename().string(), file);
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
    one["bytes"] = status.st_size;
    one["modified"] =
        static_cast<std::int64_t>(status.st_mtim.tv_sec) * 1000 + status.st_mtim.tv_nsec / 1'000'000;
    list.push_back(std::move(one));
  }
  return text_of(list);
}

std::optional<std::string> Recordings::content(const std::string& name, Span span) const {
  const auto all = files();
  const auto found = all.find(name);
  if (found == all.end()) return std::nullopt;
  GrowingFile bytes(found->second);
  RecordingReader reader;
  const std::shared_ptr<const Analysis> analysis = analyses_.of(file_.read().text);
  std::vector<std::uint32_t> transitions;
  json firings = json::array();
  std::uint64_t dropped = 0;
  std::optional<ValueSeries> values;
  for (std::string some; !(some = bytes.more()).empty() && reader.problem().empty();) {
    reader.feed(some);
    if (transitions.empty() && reader.has_header() && analysis->net)
      transitions = NetNames(*analysis->net).transitions_of(reader.recording());
    if (!values && reader.has_header()) values.emplace(reader.recording());
    for (const Recording::Entry& entry : std::exchange(reader.recording().entries, {})) {
      const Event& event = entry.event;
      const bool shown = event.time_ns >= span.from_ns && event.time_ns <= span.to_ns;
      if (event.kind() == Event::Kind::value) values->add(entry, shown);
      if (event.kind() != Event::Kind::firing || !shown) continue;
      if (event.subject >= transitions.size() || transitions[event.subject] == UINT32_MAX ||
          firings.size() >= most_firings)
        ++dropped;
      else
        firings.push_back({event.time_ns, transitions[event.subject]});
    }
  }
  if (!reader.has_header()) throw std::runtime_error(name + " is no recording");
  // Threads write one after the other; who watches wants the order of time.
  if (reader.recording().clock != "simulated")
    std::stable_sort(firings.begin(), firings.end(), [](const json& a, const json& b) {
      return a[0].get<std::int64_t>() < b[0].get<std::int64_t>();
    });
  const Recording& recording = reader.recording();
  return text_of(json{{"net_hash", recording.net_hash},
                      {"system", recording.system},
                      {"subsystems", recording.instances},
                      {"firings", std::move(firings)},
                      {"dropped", dropped},
                      {"values", values->take()},
                      {"truncated", dropped > 0 || !values->complete() || !reader.problem().empty() ||
                                        reader.pending() > 0}});
}

}  // namespace tessera::server
