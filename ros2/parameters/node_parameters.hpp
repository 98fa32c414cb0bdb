#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ros2/parameters/messages.hpp"
#include "tessera/ros2_nodes.hpp"

namespace tessera::ros2 {

/// The services of parameters that every node of ROS 2 has.
enum class ParameterService : std::uint8_t { list, get, types, describe, set, set_all };
struct ParameterServiceName {
  ParameterService service;
  const char* name;  ///< behind the name of the node
  const char* type;
};
inline constexpr std::array<ParameterServiceName, 6> parameter_services{
    {{ParameterService::list, "list_parameters", "rcl_interfaces/srv/ListParameters"},
     {ParameterService::get, "get_parameters", "rcl_interfaces/srv/GetParameters"},
     {ParameterService::types, "get_parameter_types", "rcl_interfaces/srv/GetParameterTypes"},
     {ParameterService::describe, "describe_parameters", "rcl_interfaces/srv/DescribeParameters"},
     {ParameterService::set, "set_parameters", "rcl_interfaces/srv/SetParameters"},
     {ParameterService::set_all, "set_parameters_atomically", "rcl_interfaces/srv/SetParametersAtomically"}}};

/// The name in a node with these agents of something with that path; nullopt: it belongs to another node.
[[nodiscard]] std::optional<std::string> name_in_node(const std::set<std::string>& agents,
                                                      std::string_view path);

/// The parameters of the agents of one node. A parameter is named after its subsystem: "control.v"; if the node has
/// several agents: "robot.control.v".
///
/// Threads: one at a time.
class NodeParameters {
 public:
  /// node: its full name. host: must outlive this.
  NodeParameters(Ros2Host& host, std::string node, std::set<std::string> agents);

  [[nodiscard]] std::optional<std::string> name_of(std::string_view path) const {
    return name_in_node(agents_, path);
  }
  /// The reply to a request; nullopt: that is no such request.
  [[nodiscard]] std::optional<std::vector<std::byte>> answer(ParameterService service,
                                                             std::span<const std::byte> request);
  /// The message about new and changed parameters since the last call; nullopt: there are none.
  [[nodiscard]] std::optional<std::vector<std::byte>> event(const Stamp& stamp);

 private:
  struct Known {
    std::string name;
    Ros2Parameter parameter;
  };
  [[nodiscard]] std::vector<Known> known() const;
  [[nodiscard]] std::vector<std::byte> set(std::span<const NamedValue> values, bool all_or_none);

  Ros2Host& host_;
  std::string node_;
  std::set<std::string> agents_;
  std::optional<std::vector<std::string>> told_;  ///< the values in the last event
};

}  // namespace tessera::ros2
