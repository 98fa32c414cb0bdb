#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mcap/records.hpp"
#include "tessera/recording.hpp"

namespace tessera::bag {

/// A message that a recording becomes.
struct Converted {
  std::size_t channel = 0;  ///< into Conversion::channels
  std::uint64_t log_ns = 0, publish_ns = 0;
  std::string_view data;  ///< valid during the call
  /// false: the data are not known, because the entry refers to earlier ones that are missing.
  bool is_known = true;
};
using Give = std::function<void(const Converted&)>;

/// A channel of a bag, before it has a number there.
struct ChannelPlan {
  mcap::Schema schema;  ///< without a name: the channel has none
  mcap::Channel channel;
};

/// The time of an event as bags have it: they have none before the start of the run.
[[nodiscard]] inline std::uint64_t bag_time(std::int64_t time_ns) {
  return time_ns < 0 ? 0 : static_cast<std::uint64_t>(time_ns);
}

/// A real buffer whose values are messages of a topic of ROS 2, and how they correspond (ros2/codec/translator.hpp).
struct RosBuffer {
  std::string path;        ///< "robot.base.velocity"
  std::string topic;       ///< "/cmd_vel"
  std::string type;        ///< "geometry_msgs/msg/Twist"
  std::string definition;  ///< that of the message and of all that it uses
  std::string fields, names, frame_id;
  bool operator==(const RosBuffer&) const = default;
};

/// The things that a recording does not say about the system.
struct Background {
  std::vector<RosBuffer> ros;
  /// Per type of a buffer that has no message: path of the buffer -> field -> unit.
  std::map<std::string, std::map<std::string, std::string>> units;
  struct File {
    std::string name, media_type, content;
  };
  std::vector<File> files;  ///< the specification with all its files, the net
};

}  // namespace tessera::bag
