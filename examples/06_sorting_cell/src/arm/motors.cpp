#include "arm/motors.hpp"

namespace sorting_cell::arm::motors {

/// Behaviour move of arm.motors.
void move(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.command = in.goal; }

}  // namespace sorting_cell::arm::motors
