#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ros2/codec/translator.hpp"
#include "ros2/tf/transform.hpp"

namespace tessera::ros2 {

/// geometry_msgs/msg/TransformStamped.
struct StampedTransform {
  Stamp stamp{};
  std::string parent{}, child{};
  Transform transform{};
};

/// tf2_msgs/msg/TFMessage, with its encapsulation header. Reads any bytes; nullopt: they are no such message.
[[nodiscard]] std::optional<std::vector<StampedTransform>> read_tf_message(
    std::span<const std::byte> message);
[[nodiscard]] std::vector<std::byte> tf_message(std::span<const StampedTransform> transforms);

inline constexpr const char* tf_message_type = "tf2_msgs/msg/TFMessage";

}  // namespace tessera::ros2
