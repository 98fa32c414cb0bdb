#include "sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/unknown_name.hpp"

namespace tessera::sim {
namespace {

constexpr Duration sampling_period = std::chrono::milliseconds(10);
constexpr double line_threshold = 0.5;

/// The point nearest to the mean of all: for three sensors in a row, the middle one.
Point middle_of(const std::vector<Point>& points) {
  Point mean;
  for (const Point& p : points) {
    mean.x_m += p.x_m / static_cast<double>(points.size());
    mean.y_m += p.y_m / static_cast<double>(points.size());
  }
  return *std::ranges::min_element(
      points, {}, [&](const Point& p) { return std::hypot(p.x_m - mean.x_m, p.y_m - mean.y_m); });
}

}  // namespace

Simulation::Simulation(std::unique_ptr<Physics> physics, std::optional<Track> floor, std::string trace)
    : physics_(std::move(physics)), floor_(std::move(floor)), trace_(std::move(trace)) {}

void Simulation::advance_to(Time time) {
  const std::scoped_lock lock(mutex_);
  while (physics_->failure().empty()) {
    if (physics_->time() >= next_sample_) sample();
    watched_.look(*physics_);
    if (physics_->next_time() > time.time_since_epoch()) break;
    physics_->step();
  }
}

WorldScene Simulation::scene(std::span<const DriverRequest> devices) const {
  const std::scoped_lock lock(mutex_);
  return PoseSampler::scene(*physics_, floor_ ? &*floor_ : nullptr, devices);
}

void Simulation::show_poses(PoseSink& sink) {
  const std::scoped_lock lock(mutex_);
  watched_.show(sink);
}

void Simulation::sample() {
  next_sample_ += sampling_period;
  if (!trace_.wanted()) return;
  trace_.begin(robot_names());
  if (robots_.size() > 1) return;
  const Pose robot = robots_.empty() ? physics_->robot().value_or(Pose{}) : physics_->pose(*robots_.begin());
  TracePoint point{.t_s = seconds(physics_->time()),
                   .x_m = robot.at.x_m,
                   .y_m = robot.at.y_m,
                   .heading_rad = robot.heading_rad};
  std::vector<Point> positions;
  for (const Eye& eye : eyes_) {
    positions.push_back(physics_->site_position(eye.site));
    point.on_line = point.on_line || light_under(eye) < line_threshold;
  }
  const Point middle = positions.empty() ? robot.at : middle_of(positions);
  point.eye_x_m = middle.x_m;
  point.eye_y_m = middle.y_m;
  trace_.add(point);
}

std::vector<std::string> Simulation::robot_names() const {
  std::vector<std::string> names;
  for (const Physics::RootBody robot : robots_) names.push_back(physics_->name(robot));
  return names;
}

std::optional<Problem> Simulation::finish() {
  const std::scoped_lock lock(mutex_);
  trace_.begin(robot_names());  // of a run that has ended before it began
  std::optional<Problem> problem = trace_.finish();
  if (!physics_->failure().empty()) return Problem{physics_->failure()};
  return problem;
}

Result<int> Simulation::add_eye(const std::string& site, double footprint_m) {
  const std::scoped_lock lock(mutex_);
  const auto id = physics_->site(site);
  if (!id) return Problem{unknown_name("site", site, physics_->sites())};
  eyes_.push_back({*id, footprint_m});
  robots_.insert(physics_->root_of_site(*id));
  return static_cast<int>(eyes_.size()) - 1;
}

Result<int> Simulation::add_actuator(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  const auto id = physics_->actuator(name);
  if (!id) return Problem{unknown_name("actuator", name, physics_->actuators())};
  if (const auto root = physics_->root_of_actuator(*id)) robots_.insert(*root);
  return *id;
}

double Simulation::light_at(int eye) {
  const std::scoped_lock lock(mutex_);
  const double light = light_under(eyes_[static_cast<std::size_t>(eye)]);
  throw_failure();
  return light;
}

double Simulation::light_under(const Eye& eye) const {
  return floor_ ? floor_->reflectance(physics_->site_position(eye.site), eye.footprint_m) : 1;
}

void Simulation::command(int actuator, double value) {
  const std::scoped_lock lock(mutex_);
  throw_failure();
  physics_->command(actuator, value);
}

void Simulation::throw_failure() const {
  if (!physics_->failure().empty()) throw std::runtime_error(physics_->failure());
}

}  // namespace tessera::sim
