#include "ros2/tf/tf_message.hpp"

#include <algorithm>
#include <array>

#include "ros2/codec/cdr.hpp"

namespace tessera::ros2 {
namespace {

constexpr std::size_t most_padding_of_tf = 3;

/// Three of the translation, four of the rotation.
using Numbers = std::array<double, 7>;

}  // namespace

std::optional<std::vector<StampedTransform>> read_tf_message(std::span<const std::byte> message) {
  auto reader = CdrReader::open(message);
  if (!reader) return std::nullopt;
  std::vector<StampedTransform> transforms;
  const std::uint32_t count = reader->length();
  for (std::uint32_t index = 0; index < count && reader->ok(); ++index) {
    StampedTransform& one = transforms.emplace_back();
    one.stamp.sec = reader->number<std::int32_t>();
    one.stamp.nanosec = reader->number<std::uint32_t>();
    one.parent = reader->text();
    one.child = reader->text();
    Numbers numbers{};
    for (double& number : numbers) number = reader->number<double>();
    const auto& [x, y, z, i, j, k, w] = numbers;
    one.transform = {{x, y, z}, {i, j, k, w}};
  }
  if (!reader->ok() || reader->left() > most_padding_of_tf) return std::nullopt;
  return transforms;
}

std::vector<std::byte> tf_message(std::span<const StampedTransform> transforms) {
  std::vector<std::byte> message;
  CdrWriter writer(message);
  writer.length(static_cast<std::uint32_t>(transforms.size()));
  for (const StampedTransform& one : transforms) {
    writer.number(&one.stamp.sec, sizeof one.stamp.sec);
    writer.number(&one.stamp.nanosec, sizeof one.stamp.nanosec);
    writer.text(one.parent);
    writer.text(one.child);
    const auto& [translation, rotation] = one.transform;
    for (const double number :
         {translation.x, translation.y, translation.z, rotation.x, rotation.y, rotation.z, rotation.w})
      writer.number(&number, sizeof number);
  }
  writer.finish();
  return message;
}

}  // namespace tessera::ros2
