#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ros2/arguments/rules.hpp"
#include "ros2/arguments/yaml.hpp"
#include "ros2/parameters/values.hpp"
#include "tessera/result.hpp"

/// Values of parameters from a command line or file of ROS 2.
namespace tessera::ros2 {

/// A value for the nodes of a name.
struct Override {
  std::string nodes;       ///< "robot", "/left/robot", "/left/*", "/**"
  std::string name;        ///< "control.kp"
  ParameterValue value{};  ///< not set: none was read yet
  std::string where{};     ///< "params.yaml:3", "-p control.kp:=0.8"
};

/// A file of parameters: each of its nodes, also without a value.
struct OverrideFile {
  std::string name;
  std::vector<std::string> nodes;
  std::vector<Override> values;
};

/// Reads "[NODE:]NAME:=VALUE". Errors: another form, or a value that is no value of a parameter.
[[nodiscard]] Result<Override> parse_override(std::string_view written);
/// Errors: the file cannot be read, or is no such file.
[[nodiscard]] Result<OverrideFile> read_override_file(const std::string& file);
[[nodiscard]] Result<OverrideFile> overrides_in(std::string_view text, const std::string& file);

/// A value of a file. As ROS 2 does: a number without a point is an integer, a text in quotes is a text, and `yes` is
/// true. Errors: a list of different types, a map, or nothing.
[[nodiscard]] Result<ParameterValue> parameter_value(const YamlNode& node);

/// Whether a node has that name. `*` stands for one part of a name, `**` for any number of them; a name without a slash
/// is in the namespace "/".
[[nodiscard]] bool is_meant(std::string_view nodes, const NodeName& node);

/// The parameters of one node.
struct NamedParameter {
  std::string name;  ///< in the node
  const Ros2Parameter* parameter = nullptr;
};
struct NodeWithParameters {
  NodeName node;
  std::vector<NamedParameter> parameters;
};
/// The changes that the overrides ask for, in their order. Errors, all of them, one a line: an unknown parameter, a
/// value of another type, use_sim_time.
[[nodiscard]] Result<std::vector<Ros2Host::Change>> changes_of(std::span<const Override> overrides,
                                                               std::span<const NodeWithParameters> nodes);

}  // namespace tessera::ros2
