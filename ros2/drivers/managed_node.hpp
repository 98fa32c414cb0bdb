#pragma once

#include <memory>
#include <string>

#include "tessera/ros2_nodes.hpp"

namespace tessera::ros2 {

/// See ManagedNodeMaker.
[[nodiscard]] std::unique_ptr<ManagedNode> make_managed_node(const ManagedNodeSetup& setup,
                                                             std::string& error);

}  // namespace tessera::ros2
