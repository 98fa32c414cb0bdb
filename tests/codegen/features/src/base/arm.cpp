#include "base/arm.hpp"

namespace features::base::arm {

/// Behaviour hold of base.arm.
void hold(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.grip = 0.7F;
  out.pose = in.goal;
  out.joints = {1, 2, 3};
}

}  // namespace features::base::arm
