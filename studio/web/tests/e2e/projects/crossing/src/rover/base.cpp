#include "rover/base.hpp"

namespace crossroads::rover::base {

/// Behaviour drive of rover.base.
/// Reads in.motion.
/// Writes out.command.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.command = in.motion; }

}  // namespace crossroads::rover::base
