#include "arm/joints.hpp"

namespace cell::arm::joints {

/// Behaviour move of arm.joints.
/// Reads in.wanted.
/// Writes out.v1 .. out.v6.
void move(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const auto& wanted = in.wanted.velocity;
  out.v1 = wanted[0];
  out.v2 = wanted[1];
  out.v3 = wanted[2];
  out.v4 = wanted[3];
  out.v5 = wanted[4];
  out.v6 = wanted[5];
}

}  // namespace cell::arm::joints
