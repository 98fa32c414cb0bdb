#include "arm/control.hpp"

namespace cell::arm::control {

/// Behaviour wave of arm.control: all joints up to `swing`, and down again. The command is a velocity.
/// Reads in.now.
/// Writes out.wanted.
void wave(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const double swing = context.parameters.swing;
  const double first = in.now.position[0];
  if (first >= swing) memory.up = false;
  if (first <= 0) memory.up = true;
  out.wanted.velocity.fill(memory.up ? context.parameters.speed : -context.parameters.speed);
}

}  // namespace cell::arm::control
