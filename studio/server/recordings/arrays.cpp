#include "server/recordings/arrays.hpp"

#include <algorithm>
#include <charconv>

#include "server/http/json_text.hpp"
#include "server/recordings/pose_track.hpp"
#include "server/recordings/recording_stream.hpp"
#include "server/recordings/recordings.hpp"

namespace tessera::server {

using nlohmann::json;

namespace {

/// Shorter arrays are sent like other values.
constexpr std::size_t fewest = 2;

/// "float64[32]"
bool is_array_type(std::string_view type) {
  const std::size_t bracket = type.find('[');
  if (bracket == std::string_view::npos || !type.ends_with(']')) return false;
  const std::string_view element = type.substr(0, bracket);
  if (element != "uint8" && element != "uint16" && element != "float32" && element != "float64") return false;
  const char* const end = type.data() + type.size() - 1;
  std::size_t count = 0;
  return std::from_chars(type.data() + bracket + 1, end, count).ptr == end && count >= fewest;
}

}  // namespace

void ArrayTrack::begin(const Recording& header) {
  is_array_.clear();
  for (const Recording::Buffer& buffer : header.buffers)
    is_array_.push_back(buffer.direction == Recording::Direction::real_input && is_array_type(buffer.type));
}

void ArrayTrack::take(const replay::ValueTrack::Change& change) {
  if (change.number >= is_array_.size() || !is_array_[change.number]) return;
  const bool is_told = !change.hashed && change.bytes.size() <= largest;
  changed_[change.buffer.path] = is_told ? std::string(change.bytes) : std::string();
}

json ArrayTrack::take_changed(std::size_t most) {
  json told = json::object();
  std::size_t bytes = 0;
  while (!changed_.empty() && bytes < most) {
    const auto first = changed_.begin();
    bytes += first->first.size() + first->second.size() * 4 / 3 + 8;
    told[first->first] = first->second.empty() ? json(nullptr) : json(base64_of(first->second));
    changed_.erase(first);
  }
  return told;
}

namespace {

/// The part of the arrays that is shown.
class ArrayPart {
 public:
  explicit ArrayPart(Recordings::Span span) : span_(span) {}

  void begin(const Recording& header) {
    values_.emplace(header);
    arrays_.begin(header);
  }
  /// false: the part is complete.
  [[nodiscard]] bool add(const Recording::Entry& entry) {
    const std::int64_t time_ns = entry.event.time_ns;
    const auto change = values_->follow(entry);
    if (time_ns > span_.to_ns) return false;
    if (!change) return true;
    // The values before the span are shown at its beginning; within it, all changes are shown at one time.
    const bool is_due = time_ns >= std::max(due_ns_, span_.from_ns);
    if (is_due && arrays_.has_changed()) show(std::max(last_ns_, span_.from_ns));
    arrays_.take(*change);
    last_ns_ = time_ns;
    return bytes_ < Recordings::most_array_bytes;
  }
  void end(bool complete) {
    if (arrays_.has_changed()) show(std::max(last_ns_, span_.from_ns));
    until_ns_ = complete ? std::max(last_ns_, span_.to_ns) : last_ns_;
  }
  [[nodiscard]] json take() { return {{"arrays", std::move(rows_)}, {"until", until_ns_}}; }

 private:
  static constexpr std::int64_t between_ns = 100'000'000;

  void show(std::int64_t time_ns) {
    json all = arrays_.take_changed(SIZE_MAX);
    for (const auto& [path, bytes] : all.items())
      bytes_ += path.size() + (bytes.is_string() ? bytes.get_ref<const std::string&>().size() : 0);
    rows_.push_back({time_ns, std::move(all)});
    due_ns_ = time_ns + between_ns;
  }

  const Recordings::Span span_;
  std::optional<replay::ValueTrack> values_;
  ArrayTrack arrays_;
  json rows_ = json::array();
  std::int64_t due_ns_ = INT64_MIN, last_ns_ = INT64_MIN, until_ns_ = INT64_MIN;
  std::size_t bytes_ = 0;
};

}  // namespace

std::optional<std::string> Recordings::arrays(const std::string& name, Span span) const {
  const auto all = files();
  const auto found = all.find(name);
  if (found == all.end()) return std::nullopt;
  ArrayPart part(span);
  read_part(found->second, part);
  return text_of(part.take());
}

}  // namespace tessera::server
