#include "robot/control.hpp"

namespace teleoperation::robot::control {

void obey(Context&, const Inputs& in, Memory&, Outputs& out) {
  constexpr double radius_m = 0.03, half_axle_m = 0.1;
  // The stick to the right means a turn to the right.
  out.wheels.left = (in.wish.forward + in.wish.turn * half_axle_m) / radius_m;
  out.wheels.right = (in.wish.forward - in.wish.turn * half_axle_m) / radius_m;
}

}  // namespace teleoperation::robot::control
