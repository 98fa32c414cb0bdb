#include "arm/motors.hpp"

namespace reach::arm::motors {

/// Behaviour drive of arm.motors.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.command = in.wanted.angle;
}

}  // namespace reach::arm::motors
