#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

/// MCAP, the container format of ROS 2 bags (https://mcap.dev/spec), version 0. A file is a sequence of
/// records. Its messages stand in chunks, which have a check sum each.
namespace tessera::mcap {

/// The first and the last bytes of a file. The digit is the version.
inline constexpr std::string_view magic{"\x89MCAP0\r\n", 8};

enum class Opcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0a,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f
};

/// The type of the messages of a channel.
struct Schema {
  std::uint16_t id = 0;
  std::string name;      ///< "geometry_msgs/msg/Twist"
  std::string encoding;  ///< "ros2msg", "jsonschema"
  std::string data;
  bool operator==(const Schema&) const = default;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema = 0;  ///< 0: none
  std::string topic;
  std::string encoding;  ///< of its messages: "cdr", "json"
  std::map<std::string, std::string> metadata;
  bool operator==(const Channel&) const = default;
};

/// Times are in ns; what they count from is up to the writer of the file.
struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_ns = 0;
  std::uint64_t publish_ns = 0;
  std::string_view data;
};

/// A whole file inside the file.
struct Attachment {
  std::uint64_t log_ns = 0;
  std::string name, media_type;
  std::string_view data;
};

struct Metadata {
  std::string name;
  std::map<std::string, std::string> entries;
};

}  // namespace tessera::mcap
