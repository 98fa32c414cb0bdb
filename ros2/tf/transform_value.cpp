#include "ros2/tf/transform_value.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

#include "ros2/codec/cdr.hpp"
#include "ros2/codec/message_steps.hpp"
#include "ros2/definitions/resolver.hpp"

namespace tessera::ros2 {
namespace {

constexpr const char* structure_name = "tessera/msg/Transform";
constexpr std::string_view structure_text = R"(geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
float64 x
float64 y
float64 z
float64 roll
float64 pitch
float64 yaw
builtin_interfaces/Time stamp
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x 0
float64 y 0
float64 z 0
float64 w 1
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
)";

/// Those of the message before the stamp.
using NumbersOfTransform = std::array<double, 13>;

/// The first parts of the paths in the message.
std::set<std::string> used_fields(const Mapping& mapping, const ValueType& value) {
  std::set<std::string> used;
  for (const auto& [path, field] : mapping.fields) used.insert(path.substr(0, path.find('.')));
  if (mapping.fields.empty())
    for (const ValueType::Member& member : value.members) used.insert(member.name);
  return used;
}

/// The part of the buffer with that path; nullptr: there is none.
const ValueType* part_of(const ValueType& value, std::string_view path) {
  const ValueType* part = &value;
  while (part != nullptr && !path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    const ValueType::Member* const member = part->find(path.substr(0, dot));
    part = member == nullptr ? nullptr : &member->type;
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return part;
}

/// Whether a buffer of zeros has a rotation of zeros, which is none.
bool zero_is_no_rotation(const Mapping& mapping, const ValueType& value) {
  const auto has_w = [](const ValueType* part) { return part != nullptr && part->find("w") != nullptr; };
  if (mapping.fields.empty()) return has_w(part_of(value, "rotation"));
  return std::ranges::any_of(mapping.fields, [&](const auto& one) {
    return one.first == "rotation.w" || (one.first == "rotation" && has_w(part_of(value, one.second)));
  });
}

}  // namespace

std::shared_ptr<const Structure> transform_structure() {
  std::vector<Mistake> none;
  return resolve(structure_name, DefinitionBundle(structure_name, structure_text), none);
}

std::vector<OwnField> own_fields_of_transform() {
  return {{"known", {Primitive::boolean}, /*needed=*/false, "whether there is a transform"}};
}

std::vector<std::byte> transform_message(const Transform& transform, const Stamp& stamp) {
  const auto& [translation, rotation] = transform;
  const RollPitchYaw angles = angles_of(rotation);
  std::vector<std::byte> message;
  CdrWriter writer(message);
  for (const double number : NumbersOfTransform{
           translation.x, translation.y, translation.z, rotation.x, rotation.y, rotation.z, rotation.w,
           translation.x, translation.y, translation.z, angles.roll, angles.pitch, angles.yaw})
    writer.number(&number, sizeof number);
  writer.number(&stamp.sec, sizeof stamp.sec);
  writer.number(&stamp.nanosec, sizeof stamp.nanosec);
  writer.finish();
  return message;
}

std::optional<TransformToSend> read_transform_message(std::span<const std::byte> message) {
  auto reader = CdrReader::open(message);
  if (!reader) return std::nullopt;
  NumbersOfTransform numbers{};
  for (double& number : numbers) number = reader->number<double>();
  const auto& [tx, ty, tz, i, j, k, w, x, y, z, roll, pitch, yaw] = numbers;
  // The parts that the buffer does not use change nothing.
  TransformToSend read{{{tx + x, ty + y, tz + z}, Rotation{i, j, k, w} * rotation_of({roll, pitch, yaw})},
                       {}};
  read.stamp.sec = reader->number<std::int32_t>();
  read.stamp.nanosec = reader->number<std::uint32_t>();
  if (!reader->ok()) return std::nullopt;
  return read;
}

std::optional<MappingProblem> problem_of_sent_transform(const Mapping& mapping, const ValueType& value) {
  const std::set<std::string> used = used_fields(mapping, value);
  for (const auto& [whole, parts] :
       {std::pair{"translation", std::array{"x", "y", "z"}}, {"rotation", {"roll", "pitch", "yaw"}}})
    for (const char* const part : parts)
      if (used.contains(whole) && used.contains(part))
        return MappingProblem{part, std::string("the buffer has both '") + part + "' and '" + whole + "'",
                              "give the transform in one way"};
  if (!zero_is_no_rotation(mapping, value) && value.find("known") == nullptr)
    return MappingProblem{
        "", "the buffer cannot say that there is no transform, which its safe command has to say",
        "give it a field `known: bool`, or `rotation` as a quaternion, which is zero then"};
  return std::nullopt;
}

bool gives_stamp(const Mapping& mapping) {
  return std::ranges::any_of(mapping.fields, [](const auto& one) { return one.first.starts_with("stamp"); });
}

bool begins_with_header(const Structure& message) {
  return !message.fields.empty() && is_header(message.fields.front().type);
}

std::string static_topic_of(const std::string& topic) { return topic + "_static"; }
bool is_static_topic(const std::string& topic) { return topic.ends_with("/tf_static"); }

}  // namespace tessera::ros2
