#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "sim/physics.hpp"
#include "sim/pose_sampler.hpp"
#include "sim/trace_writer.hpp"
#include "sim/track.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// The state that a world and its devices share: physics over a floor, and the trace of the robot,
/// the body that has the devices. If several bodies have devices, there is no single path; the trace
/// then only lists their names.
///
/// Threads: all members lock.
class Simulation {
 public:
  /// floor: nullopt means white everywhere.
  Simulation(std::unique_ptr<Physics> physics, std::optional<Track> floor, std::string trace);

  void advance_to(Time time);
  /// What tessera::World says about them.
  [[nodiscard]] WorldScene scene(std::span<const DriverRequest> devices) const;
  void show_poses(PoseSink& sink);
  /// Problem: the physics has failed, or the trace could not be written.
  [[nodiscard]] std::optional<Problem> finish();

  /// The site as a light sensor, which from now on counts for the trace.
  [[nodiscard]] Result<int> add_eye(const std::string& site, double footprint_m);
  /// The body that it moves counts for the trace too.
  [[nodiscard]] Result<int> add_actuator(const std::string& name);

  /// 0 dark .. 1 bright, without noise. Throws std::runtime_error once the physics has failed.
  [[nodiscard]] double light_at(int eye);
  /// Throws std::runtime_error once the physics has failed.
  void command(int actuator, double value);

 private:
  struct Eye {
    int site;
    double footprint_m;
  };
  [[nodiscard]] double light_under(const Eye& eye) const;
  void sample();
  [[nodiscard]] std::vector<std::string> robot_names() const;
  void throw_failure() const;

  mutable std::mutex mutex_;
  std::unique_ptr<Physics> physics_;
  std::optional<Track> floor_;
  std::vector<Eye> eyes_;
  std::set<Physics::RootBody> robots_;  // that have devices
  TraceWriter trace_;
  PoseSampler watched_;
  Duration next_sample_{0};
};

}  // namespace tessera::sim
