#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "ros2/dds/endpoint.hpp"
#include "ros2/drivers/service_ends.hpp"

namespace tessera::ros2 {

/// The three services and two topics of one side of an action.
///
/// Threads: one at a time.
class ActionEnds {
 public:
  /// setup: of the action; its type is "nav2_msgs/action/NavigateToPose". Throws std::runtime_error.
  explicit ActionEnds(const ServiceSetup& setup);

  ServiceEnds send_goal, get_result, cancel_goal;
  Endpoint feedback, status;  ///< read by a client, written by a server

  /// For a client: servers of all three services, which is one server if all is well.
  [[nodiscard]] ServiceEnds::Servers servers();
  /// For a client: the messages of a topic since the last call, the oldest first.
  [[nodiscard]] static std::vector<std::vector<std::byte>> messages_of(const Endpoint& topic);
};

}  // namespace tessera::ros2
