#include "parameters/ros2_parameters.hpp"

#include <cstddef>
#include <optional>

namespace tessera {
namespace {

using OfferedKind = Ros2Parameter::Kind;

/// nullopt: a structure.
std::optional<OfferedKind> ros2_kind_of(const Bindings::Parameter& parameter) {
  if (parameter.capacity > 0) return OfferedKind::text;
  if (!parameter.scalar) return std::nullopt;
  const bool array = parameter.elements > 0;
  switch (*parameter.scalar) {
    case Scalar::boolean:
      return array ? OfferedKind::booleans : OfferedKind::boolean;
    case Scalar::float32:
    case Scalar::float64:
      return array ? OfferedKind::reals : OfferedKind::real;
    default:
      return array ? OfferedKind::integers : OfferedKind::integer;
  }
}

}  // namespace

std::vector<Ros2Parameter> ros2_parameters(std::span<const ParameterOwner> owners,
                                           std::span<const Offered::Value> values) {
  std::vector<Ros2Parameter> all;
  std::size_t next = 0;
  for (const ParameterOwner& owner : owners)
    for (const Bindings::Parameter& one : owner.parameters) {
      const Offered::Value& offered = values[next++];
      const std::optional<OfferedKind> kind = ros2_kind_of(one);
      if (kind)
        all.push_back({.path = offered.path,
                       .kind = *kind,
                       .value = offered.value,
                       .unit = offered.unit,
                       .minimum = one.minimum,
                       .maximum = one.maximum,
                       .longest = one.capacity,
                       .elements = one.elements});
    }
  return all;
}

}  // namespace tessera
