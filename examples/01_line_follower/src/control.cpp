#include "robot/control.hpp"

namespace line_follower::robot::control {
namespace {

/// The paper's table. A positive angular velocity turns clockwise, towards the right.
Velocity steer(const LineReading& line, double v, double w) {
  const int seen = (line.left ? 0b100 : 0) + (line.middle ? 0b010 : 0) + (line.right ? 0b001 : 0);
  switch (seen) {
    case 0b111:
      return {v, 0};
    case 0b110:
      return {v, -w / 15};
    case 0b100:
      return {v, -w};
    case 0b011:
      return {v, w / 15};
    case 0b001:
      return {v, w};
    default:
      return {-v, -w / 2};
  }
}

}  // namespace

/// Behaviour init of robot.control: stands still for one iteration, while the first readings arrive.
void init(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = {0, 0};
  context.log("ready to follow the line at {} m/s", context.parameters.v);
}

/// Behaviour follow of robot.control.
/// Reads in.line.
/// Writes out.motion.
void follow(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = steer(in.line, context.parameters.v, context.parameters.w);
}

}  // namespace line_follower::robot::control
