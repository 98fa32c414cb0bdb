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

/// A real buffer that is a topic of ROS 2, with all that the library needs to know (docs/ros2.md).
struct Ros2Binding {
  std::string path;        ///< "robot.base.velocity"
  std::string topic;       ///< "/cmd_vel"
  std::string type;        ///< "geometry_msgs/msg/Twist"
  std::string definition;  ///< of the type and of all that it uses (ros2/definitions/resolver.hpp)
  std::string fields;      ///< "linear.x=v, angular.z=omega"; empty: equal names
  std::string names;       ///< "shoulder, elbow"; empty: none
  std::string frame_id;
  std::string qos;                      ///< "sensor, depth 1"
  std::string node;                     ///< empty: the name of the agent
  std::string interface;                ///< name or address
  std::string peers;                    ///< "10.0.0.2, cart.local"; empty: those on the interface are found
  std::optional<std::uint32_t> domain;  ///< nullopt: ROS_DOMAIN_ID, or else 0
  Duration wait{};                      ///< how long `open` waits for the other side; zero: not at all
  const ValueEncoding* encoding = nullptr;
};

/// The types of the functions that the library exports. Their names have the version of this interface.
/// nullptr and `error`: the driver cannot be made.
using Ros2ReceptorMaker = std::unique_ptr<RealReceptor> (*)(const Ros2Binding& binding, std::string& error);
using Ros2EffectorMaker = std::unique_ptr<RealEffector> (*)(const Ros2Binding& binding, std::string& error);
inline constexpr const char* ros2_receptor_function = "tessera_ros2_receptor_1";
inline constexpr const char* ros2_effector_function = "tessera_ros2_effector_1";
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
