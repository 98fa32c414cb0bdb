#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/engine/physics.hpp"
#include "sim/judging/eyes.hpp"
#include "sim/judging/judging.hpp"
#include "sim/pose_sampler.hpp"
#include "sim/trace_writer.hpp"
#include "sim/track.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// The state that a world and its devices share: physics over a floor, and the trace of the robot, which is
/// the body that has the devices. If several bodies have devices, there is no single path; the trace then
/// only lists their names.
///
/// Threads: all members lock.
class Simulation {
 public:
  /// floor: nullopt means white everywhere.
  Simulation(std::unique_ptr<Physics> physics, std::optional<Track> floor, std::string trace);

  /// Sets the checks of the run, before its first step. Problem: as Judging::read.
  [[nodiscard]] std::optional<Problem> judge_by(const std::string& checks_json);
  [[nodiscard]] std::optional<Problem> problem_with_checks(const std::string& checks_json);
  [[nodiscard]] std::vector<WorldFailure> take_failures();
  /// As Judging::results; first judges the conditions at the end.
  [[nodiscard]] std::string results();

  /// Throws std::runtime_error once the physics has failed.
  void advance_to(Time time);
  /// The scene in the form of tessera::World.
  [[nodiscard]] WorldScene scene(std::span<const DriverRequest> devices) const;
  void show_poses(PoseSink& sink);
  /// Problem: the physics has failed, or the trace could not be written.
  [[nodiscard]] std::optional<Problem> finish();

  /// Calls `use(physics)` with exclusive access. Throws std::runtime_error once the physics has failed;
  /// values that `use` has read are then meaningless.
  template <class Use>
  void use(Use&& use) {
    const std::scoped_lock lock(mutex_);
    std::forward<Use>(use)(*physics_);
    throw_failure();
  }

  /// The same for commands. A world accepts them also after its physics has failed: no body moves any more,
  /// so every command succeeds.
  template <class Use>
  void command(Use&& use) {
    const std::scoped_lock lock(mutex_);
    std::forward<Use>(use)(*physics_);
  }

  /// Adds a site as a light sensor, which from now on counts for the trace. Returns its number.
  [[nodiscard]] std::size_t add_eye(int site, double footprint_m);
  /// Adds the robot that has such a device to the trace.
  void add_robot_of_site(int site);
  void add_robot_of_actuator(int actuator);
  /// As Physics::wrap.
  void wrap(int joint, double length);

  /// 0 dark .. 1 bright, without noise. Called from within `use`.
  [[nodiscard]] double light_under(const Physics& physics, std::size_t eye) const {
    return eyes_.light_under(physics, eye);
  }

 private:
  void sample();
  [[nodiscard]] std::vector<std::string> robot_names() const;
  void throw_failure() const;

  mutable std::mutex mutex_;
  std::unique_ptr<Physics> physics_;
  Eyes eyes_;
  std::unique_ptr<Judging> judging_;    // nullptr: there are no checks or measures
  std::set<Physics::RootBody> robots_;  // the robots that have devices
  TraceWriter trace_;
  PoseSampler watched_;
  Duration next_sample_{0};
};

}  // namespace tessera::sim
