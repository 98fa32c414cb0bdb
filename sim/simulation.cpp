#include "sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/scene/scene.hpp"

namespace tessera::sim {
namespace {

constexpr Duration sampling_period = std::chrono::milliseconds(10);

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
    : physics_(std::move(physics)), eyes_(std::move(floor)), trace_(std::move(trace)) {}

void Simulation::advance_to(Time time) {
  const std::scoped_lock lock(mutex_);
  while (!physics_->failure()) {
    if (physics_->time() >= next_sample_) sample();
    watched_.look(*physics_);
    if (physics_->next_time() > time.time_since_epoch()) break;
    physics_->step();
    if (judging_ && !physics_->failure()) judging_->after_step();
  }
  throw_failure();
}

std::optional<Problem> Simulation::judge_by(const std::string& checks_json) {
  const std::scoped_lock lock(mutex_);
  if (checks_json.empty()) return std::nullopt;
  Result<std::unique_ptr<Judging>> judging = Judging::read(checks_json, *physics_, eyes_);
  if (!judging) return Problem{judging.problem()};
  judging_ = std::move(*judging);
  return std::nullopt;
}

std::optional<Problem> Simulation::problem_with_checks(const std::string& checks_json) {
  const std::scoped_lock lock(mutex_);
  const Result<std::unique_ptr<Judging>> judging = Judging::read(checks_json, *physics_, eyes_);
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
  WorldScene scene = PoseSampler::scene(*physics_, eyes_.floor(), devices);
  for (const Eyes::Eye& eye : eyes_.all())
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
  const std::optional<Eyes::Look> look = eyes_.look(*physics_, std::nullopt);
  point.on_line = look && look->on_line;
  point.eye_x_m = look ? look->middle.x_m : robot.at.x_m;
  point.eye_y_m = look ? look->middle.y_m : robot.at.y_m;
  trace_.add(point);
}

std::vector<std::string> Simulation::robot_names() const {
  std::vector<std::string> names;
  for (const Physics::RootBody robot : robots_) names.push_back(physics_->name(robot));
  return names;
}

std::optional<Problem> Simulation::finish() {
  const std::scoped_lock lock(mutex_);
  trace_.begin(robot_names());  // for a run that has ended before it began
  std::optional<Problem> problem = trace_.finish();
  if (physics_->failure()) return physics_->failure();
  return problem;
}

std::size_t Simulation::add_eye(int site, double footprint_m) {
  const std::scoped_lock lock(mutex_);
  robots_.insert(physics_->root_of_site(site));
  return eyes_.add({site, footprint_m});
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

void Simulation::throw_failure() const {
  if (physics_->failure()) throw std::runtime_error(physics_->failure()->text);
}

}  // namespace tessera::sim
