#include "robot/control.hpp"

#include <tessera/time.hpp>

namespace gap::robot::control {
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

/// The side of the robot on which more of the line is.
double side_of(const LineReading& line) {
  if (line.left == line.right) return 0;
  return line.left ? -1 : 1;
}

}  // namespace

/// Behaviour init of robot.control: stands still for one iteration, while the first readings arrive.
void init(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.motion = {0, 0}; }

/// Behaviour follow of robot.control: the table, and a note of where the line is.
/// Reads in.line.
/// Writes out.motion.
void follow(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  memory.side = side_of(in.line);
  memory.searched = 0;
  out.motion = steer(in.line, context.parameters.v, context.parameters.w);
}

/// Behaviour search of robot.control: straight on first, as over a gap, then in a circle to the side where
/// the line was seen last. Reads in.line. Writes out.motion.
void search(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const double v = context.parameters.v;
  if (memory.searched == 0) context.log("lost the line");
  const double turn = memory.side < 0 ? -context.parameters.w : context.parameters.w;
  out.motion = {v, memory.searched < context.parameters.reach ? 0 : turn};
  memory.searched += v * tessera::seconds(context.period);
}

/// Behaviour rest of robot.control: the line is nowhere near.
/// Writes out.motion.
void rest(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = {0, 0};
  context.stop("found no line");
}

}  // namespace gap::robot::control
