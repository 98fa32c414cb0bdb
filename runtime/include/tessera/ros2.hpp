#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tessera/device.hpp"

// The folder of the libraries that controllers load at run time; tesseraConfig.cmake sets it.
#ifndef TESSERA_LIBRARIES
#define TESSERA_LIBRARIES ""
#endif

namespace tessera {

/// A real buffer that is a ROS 2 topic or one side of a service or action, with everything that the library needs to
/// know about it (docs/use/ros2.md).
struct Ros2Binding {
  std::string path;   ///< "robot.base.velocity"
  std::string topic;  ///< "/cmd_vel", or the name of a service or action
  std::string type;  ///< "geometry_msgs/msg/Twist", "std_srvs/srv/SetBool", "nav2_msgs/action/NavigateToPose"
  /// The definition of the message, or of the service's or action's message that the buffer has, and of all
  /// messages it uses (ros2/definitions/resolver.hpp).
  std::string definition;
  std::string role;    ///< side of a service or action: "client" or "server"; empty: a topic
  std::string fields;  ///< "linear.x=v, angular.z=omega"; empty: equal names
  std::string names;   ///< "shoulder, elbow"; empty: none
  std::string frame_id;
  std::string frame, in;  ///< of a transform: the frame, and the one in which its pose is given; empty: none
  std::string
      at;  ///< the real buffer beside it at whose stamps the transform is given; empty: the newest one
  bool one_publisher = false;           ///< receptors: messages of two publishers at a time are a fault
  std::string qos;                      ///< "sensor, depth 1"
  std::string node;                     ///< empty: the name of the agent
  std::string interface;                ///< name or address
  std::string peers;                    ///< "10.0.0.2, cart.local"; empty: those on the interface are found
  std::optional<std::uint32_t> domain;  ///< nullopt: ROS_DOMAIN_ID, or else 0
  Duration wait{};                      ///< how long `open` waits for the other side; zero: not at all
  Duration timeout{};                   ///< how long a call or stage may last; zero: the default
  const ValueEncoding* encoding = nullptr;
};

/// Publishes the time of a simulated run as /clock, for nodes of ROS 2 with use_sim_time.
class Ros2Clock {
 public:
  Ros2Clock() = default;
  Ros2Clock(const Ros2Clock&) = delete;
  Ros2Clock& operator=(const Ros2Clock&) = delete;
  virtual ~Ros2Clock() = default;
  /// Sets the time that drivers write into the headers of their messages from now on.
  virtual void set(Duration since_start) = 0;
  virtual void publish(Duration since_start) = 0;
};

/// The types of the functions that the library exports. Their names have the version of this interface.
/// nullptr and `error`: the driver cannot be made.
using Ros2ReceptorMaker = std::unique_ptr<RealReceptor> (*)(const Ros2Binding& binding, std::string& error);
using Ros2EffectorMaker = std::unique_ptr<RealEffector> (*)(const Ros2Binding& binding, std::string& error);
inline constexpr const char* ros2_receptor_function = "tessera_ros2_receptor_4";
inline constexpr const char* ros2_effector_function = "tessera_ros2_effector_4";
/// interface: the network interface, by name or address. The domain is that of ROS_DOMAIN_ID, or else 0.
using Ros2ClockMaker = std::unique_ptr<Ros2Clock> (*)(const std::string& interface, std::string& error);
inline constexpr const char* ros2_clock_function = "tessera_ros2_clock_2";
inline constexpr const char* ros2_library_name = "libtessera_ros2.so";

/// Loads the library, which stays loaded, and makes a driver of it. The library is that of the environment
/// variable TESSERA_ROS2_LIBRARY, or else `ros2_library_name` beside the program or in `folder`.
///
/// Errors: throw DriverError: no library, or one of another version; wrong options.
[[nodiscard]] std::unique_ptr<RealReceptor> make_ros2_receptor(const DriverSetup& setup,
                                                               const ValueEncoding* encoding,
                                                               const char* folder);
[[nodiscard]] std::unique_ptr<RealEffector> make_ros2_effector(const DriverSetup& setup,
                                                               const ValueEncoding* encoding,
                                                               const char* folder);

/// Generated controllers call these. Value: the type of the real buffer.
template <class Value>
[[nodiscard]] std::unique_ptr<RealReceptor> ros2_receptor(const DriverSetup& setup) {
  return make_ros2_receptor(setup, value_encoding_of<Value>(), TESSERA_LIBRARIES);
}
template <class Value>
[[nodiscard]] std::unique_ptr<RealEffector> ros2_effector(const DriverSetup& setup) {
  return make_ros2_effector(setup, value_encoding_of<Value>(), TESSERA_LIBRARIES);
}

}  // namespace tessera
