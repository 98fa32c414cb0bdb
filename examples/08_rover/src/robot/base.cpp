#include "robot/base.hpp"

namespace scout::robot::base {

/// Behaviour drive of robot.base.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.command = in.motion; }

}  // namespace scout::robot::base
