#pragma once

#include <mujoco/mujoco.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/engine/model.hpp"
#include "sim/track.hpp"
#include "tessera/result.hpp"
#include "tessera/time.hpp"

namespace tessera::sim {

/// A MuJoCo model with its state. Any complaint of the engine, error or warning (it only warns of an unstable
/// simulation), stops this physics for good and is in failure(). It never ends the process.
///
/// *Reading does not disturb.* Queries, however many, do not change a bit of the next steps. They are
/// computed on a copy of the state, because the engine rounds the state when it computes them.
///
/// *Readings are those of the instant.* Commands and changes wait for the next step, so the order of readers
/// and writers does not matter.
///
/// *Buffers grow.* If a step needs more contacts, constraints or stack than there are, it is repeated in
/// larger buffers, with the same result as if they had been large from the start.
///
/// Threads: one at a time.
class Physics {
 public:
  /// Problem: as load_model, or the engine cannot make the state.
  [[nodiscard]] static Result<std::unique_ptr<Physics>> load(const std::string& mjcf);
  /// name: of the file, for messages.
  [[nodiscard]] static Result<std::unique_ptr<Physics>> of(ModelPtr model, const std::string& name);

  /// Sets the state before the first step.
  void start_with(const std::function<void(const mjModel& model, mjData& data)>& set);
  /// One time step. Does nothing after a failure.
  void step();
  [[nodiscard]] Duration time() const { return steps_ * step_; }
  [[nodiscard]] Duration next_time() const { return (steps_ + 1) * step_; }
  [[nodiscard]] const std::optional<Problem>& failure() const { return failure_; }

  [[nodiscard]] const mjModel& model() const { return *model_; }
  /// The poses of bodies, geoms, sites and cameras now. All else in it may be old.
  [[nodiscard]] const mjData& positions() const;
  /// The state of this instant with velocities, forces, contacts and sensors (without noise). It is computed
  /// once an instant. After a failure its content means nothing.
  [[nodiscard]] const mjData& state() const;

  /// Calls `use(geom, other geom)` for each pair that touched when the last step began.
  template <class Use>
  void for_contacts_of_last_step(Use&& use) const {
    for (int index = 0; index < data_->ncon; ++index)
      if (data_->contact[index].dist <= 0) use(data_->contact[index].geom1, data_->contact[index].geom2);
  }

  /// Commands an actuator from the next step on.
  void command(int actuator, double value) { commands_[static_cast<std::size_t>(actuator)] = value; }
  /// From now on, the position of a slide or hinge joint moves back by `length` at the end of a step that
  /// leaves it further than that from 0. So a belt runs without end.
  void wrap(int joint, double length) { wraps_[model_->jnt_qposadr[joint]] = length; }
  /// Any other change. It takes effect at the beginning of the next step, in the order of the calls. `state`
  /// is the state to change, `positions` that of positions().
  using Change = std::function<void(mjModel& model, mjData& state, const mjData& positions)>;
  void before_next_step(Change change) { changes_.push_back(std::move(change)); }

  /// The pose of the body on the first free joint, the robot. nullopt: the world has no free joint.
  [[nodiscard]] std::optional<Pose> robot() const;
  /// Puts the robot there, at rest, at the height that the world file gives. Needs robot().
  void place_robot(const Pose& pose);

  /// A body that is attached to the world itself, fixed or free to move, with everything attached to it: a
  /// robot, an arm, a ball.
  struct RootBody {
    int body = 0;
    friend auto operator<=>(const RootBody&, const RootBody&) = default;
  };
  [[nodiscard]] RootBody root_of_body(int body) const { return {model_->body_rootid[body]}; }
  [[nodiscard]] RootBody root_of_site(int site) const { return root_of_body(model_->site_bodyid[site]); }
  /// nullopt: the actuator moves no body of its own, such as a tendon between two.
  [[nodiscard]] std::optional<RootBody> root_of_actuator(int actuator) const;
  [[nodiscard]] Pose pose(RootBody root) const;
  [[nodiscard]] std::string name(RootBody root) const;
  [[nodiscard]] Point site_position(int site) const;

 private:
  /// All that a step changes and the next step needs.
  struct Kept {
    std::vector<mjtNum> qpos, qvel, act, warmstart;
    mjtNum time = 0;
  };
  Physics(ModelPtr model, DataPtr data, DataPtr view);
  void apply_commands();
  void wrap_positions();
  void keep_state();
  void restore_state();
  /// Runs `compute`, again in larger buffers as long as they are too small. Returns the complaint of the
  /// engine.
  [[nodiscard]] std::optional<Problem> in_buffers_that_suffice(const std::function<void()>& compute) const;
  /// Makes the buffers larger. Returns why that is not possible.
  [[nodiscard]] std::optional<Problem> grow(const mjData& full, bool stack) const;
  void copy_state_to_view() const;
  void fail(const Problem& complaint) const;

  ModelPtr model_;
  mutable DataPtr data_;
  mutable DataPtr view_;  // read by the queries
  std::vector<mjtNum> commands_;
  std::vector<Change> changes_;
  std::map<int, double> wraps_;  // by the index in qpos
  Kept kept_;
  mutable std::optional<Problem> failure_;
  Duration step_{0};
  std::int64_t steps_ = 0;
  int robot_joint_ = -1;
  mutable enum class View : std::uint8_t { old, positions, all } known_ = View::old;
};

}  // namespace tessera::sim
