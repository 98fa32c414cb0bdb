#include "arm/control.hpp"

#include <cmath>

namespace reach::arm::control {

/// Behaviour move of arm.control: to a pose; says once that it has been reached.
void move(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.wanted.angle = {0.8, 0.4, -0.6, 0.3};
  double apart = 0;
  for (std::size_t joint = 0; joint < 4; ++joint)
    apart = std::max(apart, std::abs(in.now.angle[joint] - out.wanted.angle[joint]));
  if (apart < 0.1 && !memory.reached) context.log("reached");
  memory.reached = memory.reached || apart < 0.1;
}

}  // namespace reach::arm::control
