#pragma once

#include <memory>
#include <optional>
#include <string>

#include "ros2/codec/translator.hpp"
#include "tessera/ros2.hpp"

namespace tessera::ros2 {

/// Publishes /clock on that interface, in the domain of ROS_DOMAIN_ID, reliably, as rclcpp expects it.
/// nullptr and `error`: DDS cannot be opened.
[[nodiscard]] std::unique_ptr<Ros2Clock> make_clock(const std::string& interface, std::string& error);

/// The time for headers of messages: simulated time if this process publishes it, otherwise the system clock.
/// Threads: any.
[[nodiscard]] Stamp stamp_now();

}  // namespace tessera::ros2
