#include "report/paths.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "tessera/poses.hpp"

namespace tessera::report {
namespace {

using Eye = Recording::Scene::Eye;

constexpr std::size_t most_points = 2000;
constexpr double line_threshold = 0.5;

[[nodiscard]] double seconds_of(std::int64_t time_ns) { return static_cast<double>(time_ns) * 1e-9; }

/// The point nearest to the mean of all: for three sensors in a row, the middle one.
[[nodiscard]] sim::Point middle_eye(const std::vector<sim::Point>& points) {
  sim::Point mean;
  for (const sim::Point& point : points) {
    mean.x_m += point.x_m / static_cast<double>(points.size());
    mean.y_m += point.y_m / static_cast<double>(points.size());
  }
  return *std::ranges::min_element(points, {},
                                   [&](const sim::Point& point) { return distance(point, mean); });
}

/// The trace of one robot.
class Tracer {
 public:
  Tracer(const replay::Robot& robot, const Recording::Scene& scene, const sim::Track* floor)
      : body_(robot.body), eyes_(scene.eyes), floor_(floor) {}

  void add(std::int64_t time_ns, const std::vector<BodyPose>& poses) {
    // Between two frames with nothing in between, nothing has moved.
    constexpr std::int64_t period = pose_period.count(), longest = 10 * whole_pose_period.count();
    if (!trace_.points.empty() && time_ns - last_ns_ < longest)
      for (std::int64_t at = last_ns_ + period; at < time_ns - period / 2; at += period) {
        sim::TracePoint rests = trace_.points.back();
        rests.t_s = seconds_of(at);
        trace_.points.push_back(rests);
      }
    last_ns_ = time_ns;
    trace_.points.push_back(point_at(time_ns, poses));
  }
  [[nodiscard]] sim::Trace take() { return std::move(trace_); }

 private:
  [[nodiscard]] sim::TracePoint point_at(std::int64_t time_ns, const std::vector<BodyPose>& poses) const {
    const replay::RobotPoint robot = replay::from_above(time_ns, poses[body_]);
    std::vector<sim::Point> seen;
    bool on_line = false;
    for (const Eye& eye : eyes_) {
      const replay::RobotPoint at = replay::from_above(time_ns, poses[eye.body], eye);
      seen.push_back({at.x_m, at.y_m});
      const double light = floor_ == nullptr ? 1 : floor_->reflectance(seen.back(), eye.footprint_m);
      on_line = on_line || light < line_threshold;
    }
    const sim::Point eye = seen.empty() ? sim::Point{robot.x_m, robot.y_m} : middle_eye(seen);
    return {seconds_of(time_ns), robot.x_m, robot.y_m, robot.heading_rad, eye.x_m, eye.y_m, on_line};
  }

  std::size_t body_;
  std::vector<Eye> eyes_;
  const sim::Track* floor_;
  std::int64_t last_ns_ = 0;
  sim::Trace trace_;
};

}  // namespace

std::string RunPaths::names() const {
  std::string all;
  for (const RobotPath& robot : robots) all += (all.empty() ? "" : ", ") + robot.name;
  return all;
}

RunPaths paths_in(const std::string& recording, const sim::Track* floor) {
  RunPaths paths;
  replay::PoseReader reader(recording);
  std::vector<replay::Robot> robots;
  std::vector<replay::Thinned<replay::RobotPoint>> points;
  std::optional<Tracer> tracer;
  while (const Recording::Entry* const entry = reader.next()) {
    if (entry->event.kind() != Event::Kind::poses || reader.poses().empty()) continue;
    if (!std::exchange(paths.has_poses, true)) {
      robots = replay::robots_of(*reader.header()->scene);
      points.assign(robots.size(), replay::Thinned<replay::RobotPoint>(most_points));
      if (robots.size() == 1) tracer.emplace(robots.front(), *reader.header()->scene, floor);
    }
    for (std::size_t index = 0; index < robots.size(); ++index)
      points[index].add(replay::from_above(entry->event.time_ns, reader.poses()[robots[index].body]));
    if (tracer) tracer->add(entry->event.time_ns, reader.poses());
  }
  for (std::size_t index = 0; index < robots.size(); ++index)
    paths.robots.push_back({robots[index].name, points[index].points()});
  if (tracer) paths.trace = tracer->take();
  return paths;
}

}  // namespace tessera::report
