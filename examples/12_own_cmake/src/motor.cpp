#include "cart/motor.hpp"

namespace approach::cart::motor {

void drive(Context&, const Inputs& in, Memory&, Outputs& out) { out.wheel = in.speed; }

}  // namespace approach::cart::motor
