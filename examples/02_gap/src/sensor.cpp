#include "robot/sensor.hpp"

namespace gap::robot::sensor {

/// Behaviour watch of robot.sensor: the line is dark.
/// Reads in.left, in.middle, in.right.
/// Writes out.line.
void watch(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const double threshold = context.parameters.threshold;
  out.line = {in.left < threshold, in.middle < threshold, in.right < threshold};
}

}  // namespace gap::robot::sensor
