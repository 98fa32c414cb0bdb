#pragma once

#include <span>
#include <vector>

#include "tessera/control_messages.hpp"
#include "tessera/given_values.hpp"
#include "tessera/ros2_nodes.hpp"

namespace tessera {

/// The parameters of ROS 2 for those of subsystems, with their values. Structures are left out: they cannot be given.
/// values: as ParameterChanges::offered.
[[nodiscard]] std::vector<Ros2Parameter> ros2_parameters(std::span<const ParameterOwner> owners,
                                                         std::span<const Offered::Value> values);

}  // namespace tessera
