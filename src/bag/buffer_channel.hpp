#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bag/channel.hpp"
#include "ros2/codec/translator.hpp"
#include "tessera/recording.hpp"
#include "tessera/value_text.hpp"

namespace tessera::bag {

/// The messages of one buffer: those of ROS 2 if the buffer is a topic, else JSON.
class BufferChannel {
 public:
  /// ros: nullptr: the buffer is no topic. A topic whose messages cannot be made of the values, because the
  /// conversion is exact in the other direction only, becomes JSON, too.
  BufferChannel(const Recording::Buffer& buffer, const RosBuffer* ros,
                const std::map<std::string, std::string>& units);

  [[nodiscard]] ChannelPlan plan() const;
  /// The data of the message; nullopt: the value does not have the buffer's type.
  [[nodiscard]] std::optional<std::string> message_of(std::string_view value, std::int64_t time_ns) const;

 private:
  Recording::Buffer buffer_;
  std::optional<ValueLayout> layout_;
  std::optional<RosBuffer> ros_;
  std::optional<ros2::Translator> translator_;
  std::map<std::string, std::string> units_;
};

/// How a topic and its channel correspond, as the metadata of the channel say it.
[[nodiscard]] std::map<std::string, std::string> metadata_of(const RosBuffer& ros);
/// The reverse; nullopt: the channel is not that of a topic.
[[nodiscard]] std::optional<RosBuffer> ros_buffer_of(const mcap::Channel& channel,
                                                     const mcap::Schema& schema);

/// "/robot_3/laser/scan" for "robot[3].laser.scan"
[[nodiscard]] std::string topic_of(const std::string& path);

/// The translator of the messages of a topic. nullopt and `error`: there is none.
[[nodiscard]] std::optional<ros2::Translator> translator_of(const RosBuffer& ros,
                                                            const std::string& value_type,
                                                            ros2::Direction direction, std::string& error);

}  // namespace tessera::bag
