#include "arm/encoders.hpp"

namespace arm_bench::arm::encoders {

/// Behaviour measure of arm.encoders.
void measure(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.joints = in.angles; }

}  // namespace arm_bench::arm::encoders
