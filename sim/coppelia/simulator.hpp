#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/coppelia/client.hpp"
#include "tessera/device.hpp"

namespace tessera::coppelia {

/// An object of the scene, by its CoppeliaSim handle.
struct Object {
  enum class Type : std::uint8_t {
    joint,
    vision_sensor,
    proximity_sensor,
    force_sensor,
    shape,
    dummy,
    other
  };
  std::int64_t handle = -1;
  Type type = Type::other;
};

/// The meaning of a joint's command. It depends on the mode of the joint in the scene.
enum class JointCommand : std::uint8_t {
  velocity,  ///< target velocity of its motor, rad/s or m/s
  position,  ///< target position of its controller, rad or m
  force,     ///< target force or torque, N or N m
  place,     ///< a kinematic joint is set to this position
  none       ///< no command has an effect
};

struct Picture {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> bytes;  ///< rows from the bottom
};

/// The functions of CoppeliaSim that a world needs, typed.
///
/// Errors: all members: LinkError; RefusedCall, see Client.
/// Threads: one at a time.
class Simulator {
 public:
  /// Connects, and reads version and constants. Errors: also LinkError if the version is too old.
  explicit Simulator(const WorldServer& server);

  [[nodiscard]] bool is_lost() const { return client_->is_lost(); }
  /// Reconnects after a lost connection. patience: for each answer from now on. Errors: LinkError.
  void connect_again(Duration patience);

  // The following functions concern the simulation as a whole. scene: a file name on the server.
  /// Errors: RefusedCall with the name of the file; the scene that was open before is open then.
  void load(const std::string& scene);
  /// Errors: LinkError if the open scene has no main script, without which no simulation begins.
  void require_main_script();
  void close_scene();
  [[nodiscard]] Duration time_step();
  [[nodiscard]] bool is_stopped();
  /// Whether it runs, and was neither paused nor asked to stop.
  [[nodiscard]] bool goes_on();
  void start_stepping();
  void step();
  [[nodiscard]] double time_s();
  /// Stops the simulation, and waits until it has stopped.
  void stop();
  /// Stores a text in the simulation that ends with it. Precondition: the simulation has made a step.
  void set_mark(const std::string& text);
  /// Empty: the simulation has none.
  [[nodiscard]] std::string mark();

  /// nullopt: the scene has no object at this path ("/robot/eye").
  [[nodiscard]] std::optional<Object> find(const std::string& path);
  /// The paths of all objects of a type.
  [[nodiscard]] std::vector<std::string> paths(Object::Type type);

  // Readings. nullopt: there is no value yet.
  [[nodiscard]] double joint_position(const Object& joint);
  [[nodiscard]] double joint_velocity(const Object& joint);
  /// Pose in world coordinates: x, y, z in m and a quaternion w, x, y, z.
  [[nodiscard]] std::array<double, 7> pose(const Object& object);
  /// The mean brightness of the picture of a vision sensor, from 0 to 1.
  [[nodiscard]] std::optional<double> brightness(const Object& vision_sensor);
  [[nodiscard]] std::array<int, 2> resolution(const Object& vision_sensor);
  [[nodiscard]] Picture colours(const Object& vision_sensor);
  /// Depth picture. Each pixel is a float32, in m.
  [[nodiscard]] Picture depths(const Object& vision_sensor);
  /// Distance in m to the nearest point that a proximity sensor detects; -1: it detects none.
  [[nodiscard]] std::optional<double> distance(const Object& proximity_sensor);
  /// Force in N and torque in N m, in the axes of the sensor.
  [[nodiscard]] std::optional<std::array<double, 6>> force(const Object& force_sensor);
  [[nodiscard]] bool collide(const Object& one, const Object& other);

  [[nodiscard]] JointCommand command_of(const Object& joint);
  void command(const Object& joint, JointCommand how, double value);

 private:
  template <class... Arguments>
  [[nodiscard]] nlohmann::json call(const char* function, const Arguments&... arguments);
  [[nodiscard]] std::int64_t constant(const std::string& name) const;
  void require_version();
  /// Tells open scenes apart.
  [[nodiscard]] std::int64_t scene_number();
  [[nodiscard]] Object::Type type_of(std::int64_t type) const;
  [[nodiscard]] bool is_handled_explicitly(const Object& sensor);
  [[nodiscard]] Picture picture(const char* function, const Object& sensor, int options,
                                std::size_t bytes_per_pixel);

  WorldServer server_;
  std::optional<Client> client_;
  std::string name_;  // "localhost:23000"
  std::map<std::string, std::int64_t, std::less<>> constants_;
  std::map<std::int64_t, bool> explicit_;  // sensors by handle
};

}  // namespace tessera::coppelia
