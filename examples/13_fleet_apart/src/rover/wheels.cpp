#include "rover/wheels.hpp"

namespace convoy::rover::wheels {

/// Behaviour drive of rover.wheels.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.speed = in.speed; }

}  // namespace convoy::rover::wheels
