#include "ros2/tf/transform.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera::ros2 {
namespace {

Position rotated(const Rotation& by, const Position& point) {
  // p + 2w(v x p) + 2(v x (v x p)), for the vector part v.
  const double a = 2 * (by.y * point.z - by.z * point.y), b = 2 * (by.z * point.x - by.x * point.z),
               c = 2 * (by.x * point.y - by.y * point.x);
  return {point.x + by.w * a + by.y * c - by.z * b, point.y + by.w * b + by.z * a - by.x * c,
          point.z + by.w * c + by.x * b - by.y * a};
}

Position sum(const Position& one, const Position& other) {
  return {one.x + other.x, one.y + other.y, one.z + other.z};
}

Rotation conjugate(const Rotation& rotation) { return {-rotation.x, -rotation.y, -rotation.z, rotation.w}; }

Rotation weighted(const Rotation& from, double weight, const Rotation& to, double other) {
  return {weight * from.x + other * to.x, weight * from.y + other * to.y, weight * from.z + other * to.z,
          weight * from.w + other * to.w};
}

Rotation on_arc(const Rotation& from, const Rotation& to, double share) {
  constexpr double nearly_parallel = 1e-6;  // of the sine: a chord is as good as the arc
  const double product = from.x * to.x + from.y * to.y + from.z * to.z + from.w * to.w;
  const double sign = product < 0 ? -1 : 1;  // a quaternion and its negative are one rotation
  const double angle = std::acos(std::min(1.0, std::abs(product)));
  const double sine = std::sin(angle);
  const Rotation between = sine < nearly_parallel ? weighted(from, 1 - share, to, sign * share)
                                                  : weighted(from, std::sin((1 - share) * angle) / sine, to,
                                                             sign * std::sin(share * angle) / sine);
  return normalized(between);
}

}  // namespace

Rotation operator*(const Rotation& first, const Rotation& second) {
  return {first.w * second.x + first.x * second.w + first.y * second.z - first.z * second.y,
          first.w * second.y - first.x * second.z + first.y * second.w + first.z * second.x,
          first.w * second.z + first.x * second.y - first.y * second.x + first.z * second.w,
          first.w * second.w - first.x * second.x - first.y * second.y - first.z * second.z};
}

Transform operator*(const Transform& first, const Transform& second) {
  return {sum(first.translation, rotated(first.rotation, second.translation)),
          first.rotation * second.rotation};
}

Transform inverse(const Transform& transform) {
  const Rotation back = conjugate(transform.rotation);
  const Position moved = rotated(back, transform.translation);
  return {{-moved.x, -moved.y, -moved.z}, back};
}

Transform interpolated(const Transform& from, const Transform& to, double share) {
  const auto between = [&](double first, double last) { return first + (last - first) * share; };
  const Position &a = from.translation, &b = to.translation;
  return {{between(a.x, b.x), between(a.y, b.y), between(a.z, b.z)},
          on_arc(from.rotation, to.rotation, share)};
}

Rotation rotation_of(const RollPitchYaw& angles) {
  const auto about = [](double angle) { return std::pair{std::sin(angle / 2), std::cos(angle / 2)}; };
  const auto [sr, cr] = about(angles.roll);
  const auto [sp, cp] = about(angles.pitch);
  const auto [sy, cy] = about(angles.yaw);
  return Rotation{0, 0, sy, cy} * Rotation{0, sp, 0, cp} * Rotation{sr, 0, 0, cr};
}

RollPitchYaw angles_of(const Rotation& rotation) {
  constexpr double upright = 1 - 1e-12;
  const auto& [x, y, z, w] = rotation;
  const double sine = std::clamp(2 * (w * y - z * x), -1.0, 1.0);
  if (std::abs(sine) > upright)
    return {0, std::copysign(std::numbers::pi / 2, sine),
            std::remainder(2 * std::atan2(z, w), 2 * std::numbers::pi)};
  return {std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), std::asin(sine),
          std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
}

double squared_length(const Rotation& rotation) {
  return rotation.x * rotation.x + rotation.y * rotation.y + rotation.z * rotation.z +
         rotation.w * rotation.w;
}

bool is_unit(const Rotation& rotation) {
  constexpr double tolerance = 0.01;
  return std::abs(squared_length(rotation) - 1) < tolerance;
}

Rotation normalized(const Rotation& rotation) {
  const double length = std::sqrt(squared_length(rotation));
  return {rotation.x / length, rotation.y / length, rotation.z / length, rotation.w / length};
}

bool is_finite(const Transform& transform) {
  const auto& [translation, rotation] = transform;
  for (const double number :
       {translation.x, translation.y, translation.z, rotation.x, rotation.y, rotation.z, rotation.w})
    if (!std::isfinite(number)) return false;
  return true;
}

}  // namespace tessera::ros2
