#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "sim/mjcf/preparation.hpp"
#include "sim/mjcf/xml.hpp"

namespace tessera::sim {
namespace {

using Quaternion = std::array<mjtNum, 4>;

/// The rule of the engine: lower case turns about the moved axes, upper case about the fixed ones.
Quaternion rotation(const std::vector<double>& angles, const std::string& sequence) {
  Quaternion all{1, 0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const char axis = static_cast<char>(std::tolower(static_cast<unsigned char>(sequence[i])));
    Quaternion turn{std::cos(angles[i] / 2), 0, 0, 0}, product{};
    turn[static_cast<std::size_t>(axis - 'x') + 1] = std::sin(angles[i] / 2);
    if (axis == sequence[i]) {
      mju_mulQuat(product.data(), all.data(), turn.data());
    } else {
      mju_mulQuat(product.data(), turn.data(), all.data());
    }
    all = product;
  }
  return all;
}

std::vector<double> axis_and_angle(const Quaternion& q) {
  const double sine = std::hypot(q[1], q[2], q[3]);
  if (sine == 0) return {1, 0, 0, 0};
  return {q[1] / sine, q[2] / sine, q[3] / sine, 2 * std::atan2(sine, q[0])};
}

void to_radians(std::vector<double>& angles, std::size_t from) {
  for (std::size_t i = from; i < angles.size(); ++i) angles[i] = angles[i] / 180.0 * mjPI;
}

void normalise_euler(pugi::xml_node element, const CompilerSettings& settings) {
  std::vector<double> angles = numbers_in(element.attribute("euler").value());
  if (settings.angles_in_degrees) to_radians(angles, 0);
  if (settings.euler_sequence == "xyz" || angles.size() != 3) {
    set_attribute(element, "euler", numbers_text(angles));
    return;
  }
  element.remove_attribute("euler");
  set_attribute(element, "axisangle",
                numbers_text(axis_and_angle(rotation(angles, settings.euler_sequence))));
}

}  // namespace

void normalise_orientations(pugi::xml_node root, const CompilerSettings& settings) {
  for_each_element(root, [&](pugi::xml_node element) {
    if (pugi::xml_attribute attribute = element.attribute("axisangle"); attribute) {
      std::vector<double> values = numbers_in(attribute.value());
      if (settings.angles_in_degrees) to_radians(values, 3);
      set_attribute(element, "axisangle", numbers_text(values));
    }
    if (element.attribute("euler")) normalise_euler(element, settings);
  });
}

}  // namespace tessera::sim
