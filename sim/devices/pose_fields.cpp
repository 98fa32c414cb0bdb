#include "sim/devices/pose_fields.hpp"

#include <algorithm>
#include <string_view>

namespace tessera::sim {

PlanarFields::PlanarFields(const Buffer& buffer) {
  constexpr std::array<std::string_view, 3> planar{"x", "y", "heading"};
  if (!buffer.is_real() || !std::ranges::is_permutation(buffer.fields(), planar))
    throw DeviceError("a pose is 7 numbers (x y z, quaternion w x y z), and the buffer is " + buffer.type(),
                      "make the buffer float64[7], or a structure with the fields x, y and heading");
  for (const std::string& field : buffer.fields())
    order_.push_back(static_cast<std::size_t>(std::ranges::find(planar, field) - planar.begin()));
}

}  // namespace tessera::sim
