#include "arm/motors.hpp"

namespace arm_bench::arm::motors {

/// Behaviour move of arm.motors.
void move(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.command = in.goal; }

}  // namespace arm_bench::arm::motors
