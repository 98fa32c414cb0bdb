#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "tessera/result.hpp"
#include "tessera/ros2_nodes.hpp"

/// The values of parameters, as rcl_interfaces/msg/ParameterValue has them.
namespace tessera::ros2 {

/// Its index is the type in the message; the first: not set.
using ParameterValue =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::byte>,
                 std::vector<bool>, std::vector<std::int64_t>, std::vector<double>, std::vector<std::string>>;

/// Not set if the value does not fit the types of ROS 2, such as a number of 64 bits without sign.
[[nodiscard]] ParameterValue value_of(const Ros2Parameter& parameter);

/// The value as `--set` takes it. Errors: it has another type than the parameter.
[[nodiscard]] Result<std::string> text_for(const Ros2Parameter& parameter, const ParameterValue& value);

}  // namespace tessera::ros2
