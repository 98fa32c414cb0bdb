#include "bag/buffer_channel.hpp"

#include <span>
#include <utility>

#include "bag/value_json.hpp"
#include "ros2/codec/value_type.hpp"
#include "ros2/codec/written_mapping.hpp"
#include "ros2/definitions/resolver.hpp"

namespace tessera::bag {

std::map<std::string, std::string> metadata_of(const RosBuffer& ros) {
  std::map<std::string, std::string> metadata{{"buffer", ros.path}};
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) metadata[key] = value;
  };
  add("fields", ros.fields);
  add("names", ros.names);
  add("frame_id", ros.frame_id);
  return metadata;
}

std::optional<RosBuffer> ros_buffer_of(const mcap::Channel& channel, const mcap::Schema& schema) {
  const auto text = [&](const char* key) {
    const auto found = channel.metadata.find(key);
    return found == channel.metadata.end() ? std::string() : found->second;
  };
  if (channel.encoding != "cdr" || schema.encoding != "ros2msg" || text("buffer").empty())
    return std::nullopt;
  return RosBuffer{text("buffer"), channel.topic, schema.name,     schema.data,
                   text("fields"), text("names"), text("frame_id")};
}

std::string topic_of(const std::string& path) {
  std::string topic = "/";
  for (const char one : path) {
    if (one == ']') continue;
    topic += one == '.' ? '/' : one == '[' ? '_' : one;
  }
  return topic;
}

std::optional<ros2::Translator> translator_of(const RosBuffer& ros, const std::string& value_type,
                                              ros2::Direction direction, std::string& error) {
  std::vector<ros2::Mistake> mistakes;
  const auto message = ros2::resolve(ros.type, ros2::DefinitionBundle(ros.type, ros.definition), mistakes);
  if (message == nullptr) {
    error = mistakes.empty() ? "there is no definition of " + ros.type : mistakes.front().shown();
    return std::nullopt;
  }
  const auto value = ros2::parse_value_type(value_type);
  if (!value) {
    error = "its type is none of a message";
    return std::nullopt;
  }
  std::vector<ros2::MappingProblem> problems;
  auto translator = ros2::Translator::make(
      message, *value, ros2::written_mapping(ros.fields, ros.names, ros.frame_id), direction, problems);
  if (!translator) error = problems.empty() ? "message and buffer do not correspond" : problems.front().text;
  return translator;
}

BufferChannel::BufferChannel(const Recording::Buffer& buffer, const RosBuffer* ros,
                             const std::map<std::string, std::string>& units)
    : buffer_(buffer), layout_(ValueLayout::parse(buffer.type)), units_(units) {
  std::string ignored;
  if (ros != nullptr) translator_ = translator_of(*ros, buffer.type, ros2::Direction::send, ignored);
  if (translator_) ros_ = *ros;
}

ChannelPlan BufferChannel::plan() const {
  if (ros_)
    return {{0, ros_->type, "ros2msg", ros_->definition}, {0, 0, ros_->topic, "cdr", metadata_of(*ros_)}};
  ChannelPlan plan{{}, {0, 0, topic_of(buffer_.path), "json", {{"buffer", buffer_.path}}}};
  if (layout_) plan.schema = {0, buffer_.path, "jsonschema", schema_of(*layout_, buffer_.path, units_)};
  return plan;
}

std::optional<std::string> BufferChannel::message_of(std::string_view value, std::int64_t time_ns) const {
  if (!translator_) return layout_ ? json_of(*layout_, value) : std::nullopt;
  constexpr std::uint64_t second_ns = 1'000'000'000;
  const std::uint64_t stamp_ns = bag_time(time_ns);
  std::vector<std::byte> message;
  if (!translator_->encode(
          std::as_bytes(std::span(value)),
          {static_cast<std::int32_t>(stamp_ns / second_ns), static_cast<std::uint32_t>(stamp_ns % second_ns)},
          message))
    return std::nullopt;
  return std::string(reinterpret_cast<const char*>(message.data()), message.size());
}

}  // namespace tessera::bag
