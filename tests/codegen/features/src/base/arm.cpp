#include "base/arm.hpp"

#include <limits>

namespace features::base::arm {

/// Behaviour hold of base.arm.
void hold(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.grip = 0.7F;
  out.pose = in.goal;
  out.joints = {std::numeric_limits<double>::quiet_NaN(), 2, 5};
}

}  // namespace features::base::arm
