#include "robot/control.hpp"

namespace empty_system::robot::control {

/// Behaviour run of robot.control.
void run(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}

}  // namespace empty_system::robot::control
