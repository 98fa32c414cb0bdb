#pragma once

#include <optional>
#include <string>

#include "bag/channel.hpp"
#include "tessera/recording.hpp"

/// The channels that tell in words what happened: the events as JSON, and the log of ROS 2.
namespace tessera::bag {

[[nodiscard]] ChannelPlan events_plan();
/// Firings, calls of transition functions, faults and so on; nullopt: values, poses and markings are none of them.
[[nodiscard]] std::optional<std::string> event_of(const Recording& recording, const Recording::Entry& entry);

[[nodiscard]] ChannelPlan log_plan();
/// A message of the type rcl_interfaces/msg/Log; nullopt: the entry is nothing for people.
[[nodiscard]] std::optional<std::string> log_of(const Recording& recording, const Recording::Entry& entry);

/// Seconds and nanoseconds of a time as messages of ROS 2 have it.
struct RosTime {
  std::int32_t sec;
  std::uint32_t nanosec;
};
[[nodiscard]] RosTime ros_time(std::int64_t time_ns);

/// The line between the definitions of messages.
inline constexpr const char* definition_line =
    "\n================================================================================\nMSG: ";
inline constexpr const char* time_definition = "builtin_interfaces/Time\nint32 sec\nuint32 nanosec";

}  // namespace tessera::bag
