#include "arm/cup.hpp"

namespace sorting_cell::arm::cup {

/// Behaviour feel of arm.cup.
void feel(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.holds = in.touch; }

}  // namespace sorting_cell::arm::cup
