#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "tessera/time.hpp"

namespace tessera {

/// The simulated world, for drivers that a user writes as C++ classes. DriverSetup::world() gives it to the
/// classes that `simulation: drivers:` names.
///
/// Names are looked up as for the other drivers: `v` is first the agent's own `robot[3]/v`, then the `v` of
/// the world; `/v` is the world's alone.
///
/// Reading never changes the simulation. Commands take effect at the next time step. So the order of drivers
/// at one instant does not matter.
///
/// Errors:  WorldError if the world has no such element, or once its physics has failed.
/// Threads: any; the world locks.
class WorldState {
 public:
  struct Pose {
    std::array<double, 3> position_m{};
    std::array<double, 4> quaternion{1, 0, 0, 0};  ///< w, x, y, z
  };

  WorldState() = default;
  WorldState(const WorldState&) = delete;
  WorldState& operator=(const WorldState&) = delete;
  virtual ~WorldState() = default;

  [[nodiscard]] virtual Duration time() const = 0;
  [[nodiscard]] virtual Pose body(const std::string& name) const = 0;
  [[nodiscard]] virtual Pose site(const std::string& name) const = 0;
  /// The value of the sensor, without noise.
  [[nodiscard]] virtual std::vector<double> sensor(const std::string& name) const = 0;
  /// A hinge in rad, a slide in m; a ball joint as a quaternion, a free joint as position and quaternion.
  [[nodiscard]] virtual std::vector<double> joint_position(const std::string& name) const = 0;
  [[nodiscard]] virtual std::vector<double> joint_velocity(const std::string& name) const = 0;
  /// Whether some geom of the one body touches some geom of the other.
  [[nodiscard]] virtual bool touch(const std::string& body, const std::string& other) const = 0;
  /// Commands an actuator, which keeps the value until the next command. A value that is not finite is a
  /// WorldError.
  virtual void command(const std::string& actuator, double value) = 0;
  /// Pushes the body's centre of mass with a force in N, in the axes of the world, until the next call.
  virtual void push(const std::string& body, const std::array<double, 3>& force_n) = 0;
};

class WorldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tessera
