#include "spec/devices/driver_kinds.hpp"

#include <algorithm>
#include <array>

namespace tessera::spec {
namespace {

using Values = DriverKind::Values;

constexpr std::string_view site = "a site of the world", body = "a body of the world",
                           camera = "a camera of the world";

/// name, receptors, effectors, simulated only, lists, target, values
constexpr std::array kinds = std::to_array<DriverKind>(
    {{"cpp", true, true, false, false, "a C++ class", Values::any},
     {"ros2", true, true, false, false, "a topic of ROS 2", Values::any},
     {"panel", true, false, false, false, "controls", Values::any},
     {"sensor", true, false, true, true, "a sensor of the world", Values::numbers},
     {"joint_position", true, false, true, true, "a joint of the world", Values::numbers},
     {"joint_velocity", true, false, true, true, "a joint of the world", Values::numbers},
     {"scan", true, false, true, false, site, Values::numbers},
     {"pose", true, false, true, false, "a body or site of the world", Values::numbers},
     {"contact", true, false, true, false, "a body or site of the world", Values::flag},
     {"camera", true, false, true, false, camera, Values::colours},
     {"depth", true, false, true, false, camera, Values::depths},
     {"labels", true, false, true, false, camera, Values::labels},
     {"reflectance", true, false, true, false, site, Values::number},
     {"actuator", false, true, true, true, "an actuator of the world", Values::numbers},
     {"velocity", false, true, true, true, "an actuator of the world", Values::numbers},
     {"weld", false, true, true, false, "an equality of the world", Values::flag},
     {"mocap", false, true, true, false, body, Values::numbers},
     {"place", false, true, true, false, body, Values::numbers},
     {"colour", false, true, true, false, "a geom of the world", Values::numbers}});

/// Whether all parts of a value are scalars of such a kind.
template <class IsSuch>
bool consists_of(const Type& type, const Model& model, IsSuch is_such) {
  if (type.is_sequence) return false;  // a device of the world has a fixed number of numbers
  if (type.kind == Type::Kind::scalar) return is_such(type.scalar);
  if (type.kind != Type::Kind::structure) return false;
  if (!model.structures.has(type.structure)) return true;  // unknown, which is said elsewhere
  return std::ranges::all_of(model.structures[type.structure].fields, [&](const Field& field) {
    // A structure uses only earlier ones, unless there is a cycle, which another function reports.
    const bool cycle = field.type.kind == Type::Kind::structure && field.type.structure >= type.structure;
    return cycle || consists_of(field.type, model, is_such);
  });
}

bool is_real(const Type& type, const Model& model) {
  return consists_of(type, model,
                     [](Scalar scalar) { return scalar == Scalar::float32 || scalar == Scalar::float64; });
}

bool consists_of(const Type& type, const Model& model, Scalar one) {
  return consists_of(type, model, [one](Scalar scalar) { return scalar == one; });
}

}  // namespace

const DriverKind* find_kind(std::string_view name) {
  const auto* const found = std::ranges::find(kinds, name, &DriverKind::name);
  return found == kinds.end() ? nullptr : found;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const DriverKind& kind : kinds) names.emplace_back(kind.name);
  return names;
}

bool has_values_of(const DriverKind& kind, const Type& type, const Model& model) {
  const bool one = type.kind == Type::Kind::scalar && type.extent == 0;
  switch (kind.values) {
    case Values::any:
      return true;
    case Values::number:
      return one && is_real(type, model);
    case Values::numbers:
      return is_real(type, model);
    case Values::flag:
      return one && type.scalar == Scalar::boolean;
    case Values::colours:
      return consists_of(type, model, Scalar::uint8);
    case Values::depths:
      return consists_of(type, model, Scalar::float32);
    case Values::labels:
      return consists_of(type, model, Scalar::uint16);
  }
  return false;
}

std::string_view description_of(DriverKind::Values values) {
  switch (values) {
    case Values::number:
      return "a real buffer of type float64 or float32";
    case Values::flag:
      return "a real buffer of type bool";
    case DriverKind::Values::colours:
      return "a real buffer of uint8 numbers, such as uint8[9216] for 64 x 48 pixels";
    case DriverKind::Values::depths:
      return "a real buffer of float32 numbers, such as float32[3072] for 64 x 48 pixels";
    case DriverKind::Values::labels:
      return "a real buffer of uint16 numbers, such as uint16[3072] for 64 x 48 pixels";
    default:
      return "a real buffer of float64 or float32 numbers";
  }
}

}  // namespace tessera::spec
