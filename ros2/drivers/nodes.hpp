#pragma once

#include <memory>
#include <string>

#include "tessera/ros2_nodes.hpp"

namespace tessera::ros2 {

/// See Ros2NodesMaker.
[[nodiscard]] std::unique_ptr<Ros2Nodes> make_nodes(Ros2Host& host, std::string& error);

}  // namespace tessera::ros2
