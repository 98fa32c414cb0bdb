#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/compose/placement.hpp"
#include "sim/engine/model.hpp"
#include "tessera/result.hpp"

/// Many robots in one world: MJCF model files are placed in an MJCF world file, as often as one likes.
namespace tessera::sim {

/// A model file that was compiled alone, in one of its placements.
struct PlacedModel {
  Placement placement;
  std::shared_ptr<const mjModel> alone;
};

/// What a keyframe gives an instance at the start, by the names of joints, actuators and bodies in the
/// composed world.
struct InitialValues {
  struct Joint {
    std::string name;
    std::vector<double> position, velocity;  ///< as in qpos and qvel; a free joint's are in the world
  };
  struct Actuator {
    std::string name;
    double control = 0;
    std::vector<double> activation;  ///< empty, or one
  };
  struct MocapBody {
    std::string name;
    std::vector<double> position, quaternion;
  };
  std::vector<Joint> joints;
  std::vector<Actuator> actuators;
  std::vector<MocapBody> mocap_bodies;
};

/// A world with all its models, as text. Elements without a name have one here, such as "robot[3]/(12)", so
/// that they are found again; `load` takes such names away.
struct Composition {
  std::string mjcf;
  std::vector<PlacedModel> placed;
  InitialValues initial;
  std::vector<std::string> warnings;  ///< what a model wanted and the world does not give
};

/// Puts every model where its placement says. Assets and default classes stand in the text once a model
/// file, so that fifty robots share their meshes. Options, sizes and visual settings are those of the world.
///
/// Errors:  a file is missing, no valid MJCF (the text begins with its name), needs a newer MuJoCo, or is a
///          URDF; a name is taken twice or has odd characters; a keyframe that is not there; positions that
///          are not finite; more than 10,000 placements.
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
/// Errors:  the engine refuses the whole (an element that two models share, as a rule), or an instance is
///          not what its file is alone.
/// Threads: any; one compiles at a time.
[[nodiscard]] Result<ComposedWorld> load(const Composition& composition);

/// Gives `data` the state at the start.
void set_state(const mjModel& model, const InitialState& initial, mjData& data);

}  // namespace tessera::sim
