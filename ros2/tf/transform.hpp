#pragma once

namespace tessera::ros2 {

/// Metres.
struct Position {
  double x = 0, y = 0, z = 0;
  bool operator==(const Position&) const = default;
};
/// A unit quaternion.
struct Rotation {
  double x = 0, y = 0, z = 0, w = 1;
  bool operator==(const Rotation&) const = default;
};
/// Rotations about the fixed axes x, y and z, one after the other, in radians (REP 103).
struct RollPitchYaw {
  double roll = 0, pitch = 0, yaw = 0;
};

/// The pose of a frame in another one, its parent: it carries coordinates of the frame into those of the parent.
struct Transform {
  Position translation{};
  Rotation rotation{};
  bool operator==(const Transform&) const = default;
};

/// First `second`, then `first`: the pose of c in a, of those of b in a and of c in b.
[[nodiscard]] Transform operator*(const Transform& first, const Transform& second);
[[nodiscard]] Rotation operator*(const Rotation& first, const Rotation& second);
[[nodiscard]] Transform inverse(const Transform& transform);
/// Between two transforms, linear for the translation and on the shorter arc for the rotation. share: 0 is `from`.
[[nodiscard]] Transform interpolated(const Transform& from, const Transform& to, double share);

[[nodiscard]] Rotation rotation_of(const RollPitchYaw& angles);
/// pitch is from -pi/2 to pi/2. If it is one of them, only the sum or difference of the others is determined, and
/// roll is 0.
[[nodiscard]] RollPitchYaw angles_of(const Rotation& rotation);

[[nodiscard]] double squared_length(const Rotation& rotation);
/// Whether the square of its length differs from 1 by less than a hundredth, as for tf2.
[[nodiscard]] bool is_unit(const Rotation& rotation);
/// The quaternion of length 1 with that direction. Precondition: it is not zero.
[[nodiscard]] Rotation normalized(const Rotation& rotation);
[[nodiscard]] bool is_finite(const Transform& transform);

}  // namespace tessera::ros2
