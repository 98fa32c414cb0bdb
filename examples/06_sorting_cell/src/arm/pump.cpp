#include "arm/pump.hpp"

namespace sorting_cell::arm::pump {

/// Behaviour pump of arm.pump.
void pump(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.power = in.suction; }

}  // namespace sorting_cell::arm::pump
