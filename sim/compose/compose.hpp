#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/compose/placement.hpp"
#include "sim/engine/model.hpp"
#include "tessera/result.hpp"

/// Several robots in one world: MJCF model files are placed in an MJCF world file, each any number of times.
namespace tessera::sim {

/// A model file, compiled alone, and one of its placements.
struct PlacedModel {
  Placement placement;
  std::shared_ptr<const mjModel> alone;
};

/// The start state that a keyframe gives an instance, by the names of joints, actuators and bodies in the
/// composed world.
struct InitialValues {
  struct Joint {
    std::string name;
    std::vector<double> position, velocity;  ///< as in qpos and qvel; for a free joint in world coordinates
  };
  struct Actuator {
    std::string name;
    double control = 0;
    std::vector<double> activation;  ///< empty, or one number
  };
  struct MocapBody {
    std::string name;
    std::vector<double> position, quaternion;
  };
  std::vector<Joint> joints;
  std::vector<Actuator> actuators;
  std::vector<MocapBody> mocap_bodies;
};

/// A world with all its models, as text. Elements without a name get one here, such as "robot[3]/(12)", so
/// that they can be found again; `load` removes such names.
struct Composition {
  std::string mjcf;
  std::vector<PlacedModel> placed;
  InitialValues initial;
  std::vector<std::string> warnings;  ///< requirements of a model that the world does not meet
};

/// Puts every model where its placement says. The text contains assets and default classes once per model
/// file, so that fifty robots share their meshes. Options, sizes and visual settings are those of the world.
///
/// Errors: a file is missing, no valid MJCF (the text begins with its name), needs a newer MuJoCo, or is a
/// URDF; a name is taken twice or has unusual characters; a keyframe does not exist; positions are not
/// finite; more than 10,000 placements.
/// Threads: any.
[[nodiscard]] Result<Composition> compose(const std::string& world_file,
                                          const std::vector<Placement>& placements);

/// The state at the start, in the order of the compiled world.
struct InitialState {
  std::vector<double> positions, velocities, activations, controls, mocap_positions, mocap_quaternions;
};

struct ComposedWorld {
  ModelPtr model;
  InitialState initial;
  std::vector<std::string> warnings;
};

/// Compiles a composition, and compares every instance with its file compiled alone: masses, inertias,
/// frames, joints, geoms, actuators, tendons, equalities and sensors.
///
/// Errors: the engine refuses the whole (usually because two models share an element), or an instance differs
/// from its file compiled alone.
/// Threads: any; one compiles at a time.
[[nodiscard]] Result<ComposedWorld> load(const Composition& composition);

/// Gives `data` the state at the start.
void set_state(const mjModel& model, const InitialState& initial, mjData& data);

}  // namespace tessera::sim
