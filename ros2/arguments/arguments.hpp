#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "ros2/arguments/overrides.hpp"
#include "ros2/arguments/rules.hpp"
#include "tessera/result.hpp"
#include "tessera/ros2_arguments.hpp"

/// The arguments behind `--ros-args`, as programs of ROS 2 get them from `ros2 run` and from launch files.
namespace tessera::ros2 {

struct ParsedArguments {
  std::vector<Rule> rules;
  /// Values of parameters, in the order of the command line; a file is not read yet.
  struct File {
    std::string name;
  };
  std::vector<std::variant<Override, File>> overrides;
  std::vector<std::string> without_effect;  ///< flags that were accepted
};

/// Errors: an unknown flag, a flag without a value, a wrong rule or value; what a controller cannot do: an enclave of
/// DDS security.
[[nodiscard]] Result<ParsedArguments> parse_arguments(std::span<const std::string> words);

/// Reads the arguments, fills in the result, and sets the rules of the process. Errors: as parse_arguments; rules that
/// give two nodes one name, or two names to the two drivers of a service; values that do not fit.
[[nodiscard]] std::optional<Problem> apply_arguments(Ros2Arguments& arguments);

}  // namespace tessera::ros2
