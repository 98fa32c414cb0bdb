#include "arm/joints.hpp"

namespace reach::arm::joints {

/// Behaviour measure of arm.joints.
void measure(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.now.angle = in.angles;
  if (in.hand < 0) context.log("the hand is in the floor");
}

}  // namespace reach::arm::joints
