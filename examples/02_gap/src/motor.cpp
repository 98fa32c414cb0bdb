#include "robot/motor.hpp"

namespace gap::robot::motor {

/// Behaviour drive of robot.motor: inverse kinematics of two driven wheels. Clockwise is a faster left wheel.
/// Reads in.velocity.
/// Writes out.left, out.right.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const double r = context.parameters.r;
  const double b = context.parameters.b;
  out.left = (in.velocity.linear + in.velocity.angular * b / 2) / r;
  out.right = (in.velocity.linear - in.velocity.angular * b / 2) / r;
}

}  // namespace gap::robot::motor
