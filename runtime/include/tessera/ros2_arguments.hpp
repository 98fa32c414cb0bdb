#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tessera/ros2_nodes.hpp"

namespace tessera {

/// A real buffer that is a topic, or one side of a service or action.
struct Ros2Use {
  std::string path;   ///< "robot.base.velocity"
  std::string topic;  ///< as in the specification: "/cmd_vel", "scan"
  std::string type;   ///< "geometry_msgs/msg/Twist"
  std::string role;   ///< "client", "server"; empty: a topic, or the client of an action
  std::string node;   ///< as in the specification; empty: the name of the agent
};

/// The arguments that a launch file of ROS 2 gives to a controller, and the system that they are about.
struct Ros2Arguments {
  std::vector<std::string> words;         ///< after `--ros-args`: "-r", "/cmd_vel:=/base/cmd_vel"
  std::vector<Ros2Use> uses;              ///< all of the process
  std::vector<Ros2Parameter> parameters;  ///< of all subsystems of the process
  // The result.
  std::vector<std::pair<std::string, std::string>> values{};  ///< of parameters, as `--set` takes them
  std::vector<std::string> notes{};                           ///< new names, one sentence for each
  std::vector<std::string> warnings{};
};

/// The function that the library for ROS 2 exports. It gives the names of the arguments to all drivers and nodes that
/// are made afterwards in this process. false and `error`: an argument is wrong.
using Ros2ArgumentsReader = bool (*)(Ros2Arguments& arguments, std::string& error);
inline constexpr const char* ros2_arguments_function = "tessera_ros2_arguments_1";

}  // namespace tessera
