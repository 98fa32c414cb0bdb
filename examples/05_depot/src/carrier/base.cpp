#include "carrier/base.hpp"

namespace depot::carrier::base {

/// Behaviour drive of carrier.base.
/// Reads in.motion.
/// Writes out.command.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.command = in.motion; }

}  // namespace depot::carrier::base
