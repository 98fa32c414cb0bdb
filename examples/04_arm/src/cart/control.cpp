#include "cart/control.hpp"

namespace cell::cart::control {

/// Behaviour roll of cart.control.
/// Writes out.speed.
void roll(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.speed = 0.25; }

}  // namespace cell::cart::control
