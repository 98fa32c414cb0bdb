#include "arm/control.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace arm_bench::arm::control {
namespace {

// The angles of yaw, shoulder and elbow, in rad. Yaw turns to the left; the others lower the hand.
constexpr Joints at_left{0.7, -0.1, 1.0};
constexpr Joints above_wall{0, -0.6, 0.8};
constexpr Joints at_right{-0.7, -0.1, 1.0};

constexpr double period_s = 0.02;

/// The largest distance that one of the joints has to move.
double way(const Joints& from, const Joints& to) {
  return std::max(
      {std::abs(to.yaw - from.yaw), std::abs(to.shoulder - from.shoulder), std::abs(to.elbow - from.elbow)});
}

/// One step towards `wanted`: all joints begin and end together.
void go_to(const Joints& wanted, const Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  constexpr double near_rad = 0.03;
  const bool known = in.joints.valid && in.joints.age < std::chrono::milliseconds(200);
  memory.there = known && way(in.joints, wanted) < near_rad;
  out.goal = memory.at;
  if (!known) return;
  const Joints from = memory.at;
  const double part = std::min(1.0, context.parameters.speed * period_s / std::max(way(from, wanted), 1e-9));
  memory.at = {std::lerp(from.yaw, wanted.yaw, part), std::lerp(from.shoulder, wanted.shoulder, part),
               std::lerp(from.elbow, wanted.elbow, part)};
  out.goal = memory.at;
}

}  // namespace

/// Behaviour left of arm.control: down on the left of the wall.
void left(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  go_to(at_left, context, in, memory, out);
  memory.to_right = true;
}

/// Behaviour over of arm.control: above the wall.
void over(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  go_to(above_wall, context, in, memory, out);
}

/// Behaviour right of arm.control: down on the right of the wall.
void right(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  go_to(at_right, context, in, memory, out);
  memory.to_right = false;
}

}  // namespace arm_bench::arm::control
