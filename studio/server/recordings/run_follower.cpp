#include "server/recordings/run_follower.hpp"

#include <algorithm>
#include <iterator>
#include <thread>
#include <utility>

namespace tessera::server {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

namespace {

constexpr std::size_t most_values = std::size_t{64} << 10U;  // size of one event in bytes
constexpr std::size_t most_arrivals = 4000;                  // of one event
constexpr std::size_t most_arrays = std::size_t{1} << 20U;
constexpr auto between_arrays = std::chrono::milliseconds(200);
constexpr auto between_looks = std::chrono::milliseconds(30);
constexpr auto between_values = std::chrono::milliseconds(50);
constexpr auto between_poses = std::chrono::milliseconds(50);
constexpr auto between_frames = std::chrono::milliseconds(40);
constexpr auto between_markings = std::chrono::milliseconds(500);
constexpr auto between_subsystems = std::chrono::milliseconds(200);

/// Nanoseconds of a time that comes from outside.
std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::clamp(seconds * 1e9, -9e18, 9e18));
}

}  // namespace

void add_subsystems(const Snapshot& snapshot, json& event) {
  for (const Snapshot::Subsystem& one : snapshot.subsystems)
    event["subsystems"].push_back({{"path", one.path},
                                   {"behaviour", one.behaviour ? json(*one.behaviour) : json(nullptr)},
                                   {"calling", one.calling},
                                   {"ended", one.ended},
                                   {"iterations", one.iterations},
                                   {"firings", one.firings},
                                   {"overruns", one.overruns},
                                   {"errors", one.errors},
                                   {"period_s", one.period_s},
                                   {"called_at_s", one.called_at_s},
                                   {"call_s", one.call_s},
                                   {"longest_call_s", one.longest_call_s},
                                   {"slow_calls", one.slow_calls},
                                   {"late_wakeups", one.late_wakeups},
                                   {"latest_wakeup_s", one.latest_wakeup_s}});
  for (const Snapshot::Channel& one : snapshot.channels)
    event["channels"].push_back({{"name", one.name}, {"marked", one.marked}});
}

RunFollower::RunFollower(RecordingStream::Source recording, const Analysis& analysis, Reached* reached)
    : recording_(std::move(recording), *analysis.net, reached) {}

void RunFollower::rest() { std::this_thread::sleep_for(between_looks); }

RunFollower::News RunFollower::poll(std::optional<Snapshot> snapshot, bool last) {
  News news;
  if (snapshot) snapshot_ = std::move(snapshot);
  add_path(add_firings(news), news, last);
  const bool has_read_all = !news.more;
  if (snapshot_ && has_read_all) add_snapshot(*std::exchange(snapshot_, std::nullopt), news);
  add_values(news, news.rested || (last && has_read_all));
  add_arrays(news, news.rested || (last && has_read_all));
  add_poses(news, news.rested || (last && has_read_all));
  return news;
}

std::vector<PathPoint> RunFollower::add_firings(News& news) {
  RecordingTail::Batch batch = recording_.next();
  news.more = batch.more;
  news.parameters = std::move(batch.parameters);
  news.lacks_parameters = batch.lacks_parameters;
  news.notices = recording_.notices().take();
  arrivals_.insert(arrivals_.end(), std::make_move_iterator(batch.arrivals.begin()),
                   std::make_move_iterator(batch.arrivals.end()));
  arrivals_dropped_ += batch.arrivals_dropped;
  if (arrivals_.size() > most_arrivals) {
    const auto beyond = static_cast<std::ptrdiff_t>(arrivals_.size() - most_arrivals);
    arrivals_dropped_ += static_cast<std::uint64_t>(beyond);
    arrivals_.erase(arrivals_.begin(), arrivals_.begin() + beyond);
  }
  time_ns_ = std::max(time_ns_, batch.time_ns);
  news.time_ns = time_ns_;
  if (batch.firings.empty() && batch.dropped == 0 && !batch.jumped) return std::move(batch.path);
  news.marking = recording_.marking();
  total_firings_ += batch.firings.size() + batch.dropped;
  news.total_firings = total_firings_;
  news.firings = {{"t", batch.time_ns},
                  {"dropped", batch.dropped},
                  {"total", total_firings_},
                  {"firings", batch.firings}};
  // A page that plays the firings knows the marking. It is sent from time to time,
  // in case a firing was lost.
  const bool plays_on = batch.dropped == 0 && !batch.jumped;
  if (plays_on && Clock::now() - marking_told_ < between_markings) return std::move(batch.path);
  marking_told_ = Clock::now();
  news.firings["marking"] = *news.marking;
  return std::move(batch.path);
}

/// at_once: also values that could wait a little.
void RunFollower::add_values(News& news, bool at_once) {
  if (!at_once && Clock::now() - values_told_ < between_values) return;
  json values = recording_.take_changed_values(at_once ? SIZE_MAX : most_values);
  if (values.empty() && arrivals_.empty() && arrivals_dropped_ == 0) return;
  values_told_ = Clock::now();
  json arrivals = json::object();
  for (const RecordingTail::Arrived& one : std::exchange(arrivals_, {}))
    arrivals[one.path].push_back({one.time_ns, one.written_ns, one.valid});
  news.values = {{"t", time_ns_},
                 {"values", std::move(values)},
                 {"arrivals", std::move(arrivals)},
                 {"arrivals_dropped", std::exchange(arrivals_dropped_, 0)}};
}

void RunFollower::add_arrays(News& news, bool at_once) {
  if (!at_once && Clock::now() - arrays_told_ < between_arrays) return;
  json arrays = recording_.arrays().take_changed(most_arrays);
  if (arrays.empty()) return;
  arrays_told_ = Clock::now();
  news.arrays = {{"t", time_ns_}, {"arrays", std::move(arrays)}};
}

void RunFollower::add_path(std::vector<PathPoint> path, News& news, bool at_once) {
  news.path = std::move(path);
  if (!news.path.empty()) pose_waiting_ = news.path.back();
  if (!pose_waiting_ || (!at_once && Clock::now() - pose_told_ < between_poses)) return;
  pose_told_ = Clock::now();
  const PathPoint pose = *std::exchange(pose_waiting_, std::nullopt);
  news.pose = {{"t", pose.time_ns}, {"x", pose.x_m}, {"y", pose.y_m}, {"heading", pose.heading_rad}};
}

void RunFollower::add_poses(News& news, bool at_once) {
  PoseTrack& poses = recording_.poses();
  if (!scene_told_ && !poses.scene().is_null()) {
    scene_told_ = true;
    news.scene = poses.scene();
  }
  if (!at_once && Clock::now() - poses_told_ < between_frames) return;
  const std::optional<PoseTrack::Frame> frame = poses.next_frame();
  if (!frame) return;
  poses_told_ = Clock::now();
  news.poses = {{"t", frame->time_ns}, {"frame", frame->bytes}};
  if (const std::optional<PoseTrack::Frame> whole = poses.last_whole())
    news.whole_poses = {{"t", whole->time_ns}, {"frame", whole->bytes}};
}

void RunFollower::add_snapshot(const Snapshot& snapshot, News& news) {
  const std::int64_t time_ns = nanoseconds(snapshot.time_s);
  news.time_ns = std::max(news.time_ns, time_ns);
  if (Clock::now() - subsystems_told_ >= between_subsystems) {
    subsystems_told_ = Clock::now();
    news.subsystems = {{"t", time_ns}, {"subsystems", json::array()}, {"channels", json::array()}};
    add_subsystems(snapshot, news.subsystems);
  }
  const Snapshot::Control control = snapshot.control.value_or(Snapshot::Control{});
  news.has_state = snapshot.control.has_value();
  news.paused = control.paused;
  // A step, or a breakpoint that comes soon, begins and ends between two snapshots.
  news.rested = control.pauses != std::exchange(pauses_, control.pauses) && news.paused;
  news.broke_at = control.broke_at;
}

}  // namespace tessera::server
