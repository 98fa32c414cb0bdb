#include "sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/scene/scene.hpp"

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

/// nullopt: no body that can move carries it.
std::optional<WorldScene::Eye> eye_of_scene(const Physics& physics, int site, double footprint_m) {
  const mjModel& model = physics.model();
  const mjData& now = physics.positions();
  const std::vector<int> bodies = moving_bodies(model);
  for (int body = model.site_bodyid[site]; body > 0; body = model.body_parentid[body]) {
    const auto found = std::ranges::find(bodies, body);
    if (found == bodies.end()) continue;
    mjtNum from_body[3];
    mju_sub3(from_body, now.site_xpos + 3 * site, now.xpos + 3 * body);
    WorldScene::Eye eye{.body = static_cast<std::size_t>(found - bodies.begin()), .footprint_m = footprint_m};
    mju_rotVecMatT(eye.at_m.data(), from_body, now.xmat + 9 * body);
    return eye;
  }
  return std::nullopt;
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
    if (judging_) judging_->after_step();
  }
}

std::optional<Problem> Simulation::judge_by(const std::string& checks_json) {
  const std::scoped_lock lock(mutex_);
  if (checks_json.empty()) return std::nullopt;
  Result<std::unique_ptr<Judging>> judging = Judging::read(checks_json, *physics_);
  if (!judging) return Problem{judging.problem()};
  judging_ = std::move(*judging);
  return std::nullopt;
}

std::optional<Problem> Simulation::problem_with_checks(const std::string& checks_json) {
  const std::scoped_lock lock(mutex_);
  const Result<std::unique_ptr<Judging>> judging = Judging::read(checks_json, *physics_);
  return judging ? std::nullopt : std::optional(Problem{judging.problem()});
}

std::vector<WorldFailure> Simulation::take_failures() {
  const std::scoped_lock lock(mutex_);
  return judging_ ? judging_->take_failures() : std::vector<WorldFailure>{};
}

std::string Simulation::results() {
  const std::scoped_lock lock(mutex_);
  if (!judging_) return {};
  judging_->finish();
  return judging_->results();
}

WorldScene Simulation::scene(std::span<const DriverRequest> devices) const {
  const std::scoped_lock lock(mutex_);
  WorldScene scene = PoseSampler::scene(*physics_, floor_ ? &*floor_ : nullptr, devices);
  for (const Eye& eye : eyes_)
    if (const auto seen = eye_of_scene(*physics_, eye.site, eye.footprint_m)) scene.eyes.push_back(*seen);
  return scene;
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
  for (std::size_t eye = 0; eye < eyes_.size(); ++eye) {
    positions.push_back(physics_->site_position(eyes_[eye].site));
    point.on_line = point.on_line || light_under(*physics_, eye) < line_threshold;
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

std::size_t Simulation::add_eye(int site, double footprint_m) {
  const std::scoped_lock lock(mutex_);
  eyes_.push_back({site, footprint_m});
  robots_.insert(physics_->root_of_site(site));
  return eyes_.size() - 1;
}

void Simulation::add_robot_of_site(int site) {
  const std::scoped_lock lock(mutex_);
  robots_.insert(physics_->root_of_site(site));
}

void Simulation::add_robot_of_actuator(int actuator) {
  const std::scoped_lock lock(mutex_);
  if (const auto root = physics_->root_of_actuator(actuator)) robots_.insert(*root);
}

void Simulation::wrap(int joint, double length) {
  const std::scoped_lock lock(mutex_);
  physics_->wrap(joint, length);
}

double Simulation::light_under(const Physics& physics, std::size_t eye) const {
  const Eye& one = eyes_[eye];
  return floor_ ? floor_->reflectance(physics.site_position(one.site), one.footprint_m) : 1;
}

void Simulation::throw_failure() const {
  if (!physics_->failure().empty()) throw std::runtime_error(physics_->failure());
}

}  // namespace tessera::sim
