#include "cart/motor.hpp"

namespace cell::cart::motor {

/// Behaviour turn of cart.motor: 1 m/s is full duty.
/// Reads in.speed.
/// Writes out.duty.
void turn(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.duty = in.speed; }

}  // namespace cell::cart::motor
