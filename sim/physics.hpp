#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/track.hpp"
#include "tessera/result.hpp"
#include "tessera/time.hpp"

namespace tessera::sim {

/// A MuJoCo model with its state. Any complaint of the engine, error or warning (an unstable simulation is
/// only a warning to it), stops this physics for good and is in failure(). It never ends the process.
///
/// *Reading does not disturb.* Queries, however many, do not change a bit of the next steps. Positions are
/// computed on a copy of the state, because the engine rounds the state when it computes them.
///
/// Threads: one at a time.
class Physics {
 public:
  /// Problem: the file is missing, no valid MJCF, or slower than one step in 100 ms.
  [[nodiscard]] static Result<std::unique_ptr<Physics>> load(const std::string& mjcf);

  /// One time step. Does nothing after a failure.
  void step();
  [[nodiscard]] Duration time() const { return steps_ * step_; }
  [[nodiscard]] Duration next_time() const { return (steps_ + 1) * step_; }
  [[nodiscard]] const std::string& failure() const { return failure_; }

  /// The pose of the body on the first free joint, the robot. nullopt: nothing in
  /// the world is free to move.
  [[nodiscard]] std::optional<Pose> robot() const;
  /// Puts the robot there, at rest, at the height that the world file gives. Needs robot().
  void place_robot(const Pose& pose);

  /// A body that is attached to the world itself, fixed or free to move, with all that hangs on it: a robot,
  /// an arm, a ball.
  struct RootBody {
    int body = 0;
    friend auto operator<=>(const RootBody&, const RootBody&) = default;
  };
  [[nodiscard]] RootBody root_of_site(int site) const;
  /// nullopt: the actuator moves no body of its own, such as a tendon between two.
  [[nodiscard]] std::optional<RootBody> root_of_actuator(int actuator) const;
  [[nodiscard]] Pose pose(RootBody root) const;
  [[nodiscard]] std::string name(RootBody root) const;

  [[nodiscard]] const mjModel& model() const { return *model_; }
  /// With the positions of bodies and sites as they are now.
  [[nodiscard]] const mjData& located() const {
    locate();
    return *view_;
  }

  [[nodiscard]] std::optional<int> site(const std::string& name) const;
  [[nodiscard]] Point site_position(int site) const;
  [[nodiscard]] std::optional<int> actuator(const std::string& name) const;
  void command(int actuator, double value);
  [[nodiscard]] std::vector<std::string> sites() const { return names(mjOBJ_SITE, model_->nsite); }
  [[nodiscard]] std::vector<std::string> actuators() const { return names(mjOBJ_ACTUATOR, model_->nu); }

 private:
  struct Release {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  Physics(mjModel* model, mjData* data, mjData* view, std::string&& failure);
  /// Updates the positions of bodies and sites in `view_` from the state.
  void locate() const;
  [[nodiscard]] std::vector<std::string> names(mjtObj type, int count) const;

  std::unique_ptr<mjModel, Release> model_;
  std::unique_ptr<mjData, Release> data_;
  std::unique_ptr<mjData, Release> view_;  // read by the queries
  std::string failure_;
  Duration step_{0};
  std::int64_t steps_ = 0;
  int robot_joint_ = -1;
  mutable bool located_ = false;
};

}  // namespace tessera::sim
