#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sorting_cell {

/// In metres: shoulder above the floor, links, and the way from the wrist to the face of the cup.
inline constexpr double shoulder_up = 0.25, upper_arm = 0.25, fore_arm = 0.2, hand = 0.068;

struct Angles {
  double shoulder = 0, elbow = 0, wrist = 0;
};

/// The angles for a cup that points down, `out` m from the axis of the arm and `up` m above the floor. A
/// point out of reach gives the nearest one within reach.
inline Angles angles_of(double out, double up) {
  const double height = up + hand - shoulder_up;
  const double distance = std::hypot(out, height);
  const double bend =
      (distance * distance - upper_arm * upper_arm - fore_arm * fore_arm) / (2 * upper_arm * fore_arm);
  const double elbow = std::acos(std::clamp(bend, -1.0, 1.0));
  const double shoulder = -std::atan2(height, out) -
                          std::atan2(fore_arm * std::sin(elbow), upper_arm + fore_arm * std::cos(elbow));
  return {shoulder, elbow, std::numbers::pi / 2 - shoulder - elbow};
}

/// The next number on the way to `goal`: as fast as `speed` (per second), slower towards the end.
inline double towards(double goal, double now, double speed, double period_s) {
  const double left = goal - now;
  const double step = std::min(speed * period_s, std::abs(left) * 8 * period_s + speed * 0.05 * period_s);
  return std::abs(left) <= step ? goal : now + std::copysign(step, left);
}

}  // namespace sorting_cell
