#include "robot/base.hpp"
#include "robot/laser.hpp"
#include "robot/wheels.hpp"

namespace roamer::robot {

/// Behaviour look of robot.laser: the last scan, and whether it is still true.
void laser::look(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.seen.scan = in.scan;
  out.seen.known = in.scan.valid && in.scan.age < std::chrono::milliseconds(300);
}

/// Behaviour look of robot.wheels.
void wheels::look(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.odometry = in.odometry;
}

/// Behaviour drive of robot.base.
void base::drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.command = in.motion;
}

}  // namespace roamer::robot
