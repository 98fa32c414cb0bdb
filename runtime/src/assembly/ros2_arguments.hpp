#pragma once

#include <string>
#include <vector>

#include "nets/process_part.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// Sentences for people about the arguments of ROS 2.
struct Ros2ArgumentNotes {
  std::vector<std::string> notes, warnings;
};

/// Gives the names of `options.ros2_arguments` to all drivers that are made afterwards, and adds their parameters to
/// `options.parameters`, after the others. Nothing happens without such arguments.
///
/// Errors: a wrong argument, or the library for ROS 2 cannot be loaded: false and `error`.
[[nodiscard]] bool take_ros2_arguments(const ProcessPart& part, RunOptions& options, Ros2ArgumentNotes& notes,
                                       std::string& error);

}  // namespace tessera
