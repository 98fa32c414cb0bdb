#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ros2/codec/translator.hpp"
#include "ros2/tf/transform.hpp"

/// The transform behind a real buffer, as the message with which fields of the buffer correspond.
namespace tessera::ros2 {

/// A message that exists nowhere else. It has the transform twice, with a quaternion and with angles, so that a buffer
/// may choose: `translation`, `rotation`; `x`, `y`, `z`, `roll`, `pitch`, `yaw`; and `stamp`.
[[nodiscard]] std::shared_ptr<const Structure> transform_structure();

/// The field of an effector's buffer that no message has: whether there is something to broadcast.
[[nodiscard]] std::vector<OwnField> own_fields_of_transform();
inline constexpr std::size_t known_field = 0;

[[nodiscard]] std::vector<std::byte> transform_message(const Transform& transform, const Stamp& stamp);

struct TransformToSend {
  Transform transform{};
  Stamp stamp{};
};
/// The transform in such a message whose unused parts are zero and whose unused rotation is none. Its rotation need not
/// be a unit quaternion. nullopt: the bytes are no such message.
[[nodiscard]] std::optional<TransformToSend> read_transform_message(std::span<const std::byte> message);

/// The reason why an effector cannot have such a mapping; nullopt: it can. value: the type of its buffer.
[[nodiscard]] std::optional<MappingProblem> problem_of_sent_transform(const Mapping& mapping,
                                                                      const ValueType& value);
/// Whether the buffer gives the stamp, too.
[[nodiscard]] bool gives_stamp(const Mapping& mapping);

/// Whether messages begin with a header, so that transforms can be given at their times.
[[nodiscard]] bool begins_with_header(const Structure& message);

/// The topic of fixed transforms beside one of moving ones: "/tf_static" for "/tf".
[[nodiscard]] std::string static_topic_of(const std::string& topic);
[[nodiscard]] bool is_static_topic(const std::string& topic);

}  // namespace tessera::ros2
