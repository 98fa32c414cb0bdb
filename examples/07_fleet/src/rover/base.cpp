#include "rover/base.hpp"

namespace fleet::rover::base {

/// Behaviour drive of rover.base.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.command = in.motion; }

}  // namespace fleet::rover::base
