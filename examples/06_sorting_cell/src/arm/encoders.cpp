#include "arm/encoders.hpp"

namespace sorting_cell::arm::encoders {

/// Behaviour measure of arm.encoders.
void measure(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.joints = in.angles; }

}  // namespace sorting_cell::arm::encoders
