#include "server/follower.hpp"

#include <array>
#include <charconv>
#include <thread>
#include <utility>

namespace tessera::server {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

namespace {

constexpr auto between_looks = std::chrono::milliseconds(30);
constexpr auto between_poses = std::chrono::milliseconds(50);
constexpr auto between_markings = std::chrono::milliseconds(500);
constexpr auto between_subsystems = std::chrono::milliseconds(200);

std::int64_t nanoseconds(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

/// {t, x, y, heading} of a line of a trace (sim/trace.hpp); null: it is none.
json pose_of(std::string_view line) {
  std::array<double, 4> numbers{};
  for (double& number : numbers) {
    const auto [end, problem] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (problem != std::errc{} || end == line.data() + line.size()) return nullptr;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()) + 1);
  }
  return {{"t", nanoseconds(numbers[0])}, {"x", numbers[1]}, {"y", numbers[2]}, {"heading", numbers[3]}};
}

}  // namespace

Follower::Follower(const std::filesystem::path& recording, const std::filesystem::path& path,
                   const Analysis& analysis)
    : analysis_(analysis), recording_(recording, *analysis.net), path_(path), values_(*analysis.model) {}

void Follower::rest() { std::this_thread::sleep_for(between_looks); }

Follower::News Follower::look(std::optional<json> snapshot) {
  News news;
  if (snapshot) snapshot_ = std::move(snapshot);
  add_firings(news);
  add_pose(news);
  if (snapshot_ && !news.more) add_snapshot(*std::exchange(snapshot_, std::nullopt), news);
  return news;
}

void Follower::add_firings(News& news) {
  const std::optional<RecordingTail::Batch> batch = recording_.next();
  if (!batch) return;
  news.more = batch->more;
  news.time_ns = batch->time_ns;
  if (batch->firings.empty() && batch->dropped == 0) return;
  news.marking = recording_.marking();
  news.firings = {{"t", batch->time_ns}, {"dropped", batch->dropped}, {"firings", batch->firings}};
  // A page that plays the firings knows the marking; now and then it is told, in case one was lost.
  if (batch->dropped == 0 && Clock::now() - marking_told_ < between_markings) return;
  marking_told_ = Clock::now();
  news.firings["marking"] = *news.marking;
}

void Follower::add_pose(News& news) {
  path_line_ += path_.more();
  const std::size_t end = path_line_.rfind('\n');
  if (end != std::string::npos && end > 0) {
    const std::size_t before = path_line_.rfind('\n', end - 1);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    json pose = pose_of(std::string_view(path_line_).substr(begin, end - begin));
    if (!pose.is_null()) pose_waiting_ = std::move(pose);
    path_line_.erase(0, end + 1);
  }
  if (pose_waiting_.is_null() || Clock::now() - pose_told_ < between_poses) return;
  pose_told_ = Clock::now();
  news.pose = std::exchange(pose_waiting_, nullptr);
}

void Follower::add_snapshot(const json& snapshot, News& news) {
  news.time_ns = std::max(news.time_ns, nanoseconds(snapshot.value("time_s", 0.0)));
  if (Clock::now() - subsystems_told_ >= between_subsystems) {
    subsystems_told_ = Clock::now();
    news.subsystems = {{"t", nanoseconds(snapshot.value("time_s", 0.0))},
                       {"subsystems", snapshot.value("subsystems", json::array())},
                       {"channels", snapshot.value("channels", json::array())}};
  }
  news.has_state = snapshot.contains("paused");
  news.paused = snapshot.value("paused", false);
  news.pauses = snapshot.value("pauses", std::uint64_t{0});
  news.broke_at = snapshot.value("broke_at", "");
  const auto found = snapshot.find("values");
  if (found == snapshot.end() || !found->is_object()) return;
  std::string seen = found->dump();
  if (seen == values_seen_) return;
  values_seen_ = std::move(seen);
  json values = json::object();
  for (const auto& [path, hex] : found->at("buffers").items())
    if (hex.is_string())
      if (json value = values_.read(path, hex.get<std::string>()); !value.is_null())
        values[path] = std::move(value);
  news.values = {{"t", nanoseconds(found->value("time_s", 0.0))}, {"values", std::move(values)}};
}

}  // namespace tessera::server
