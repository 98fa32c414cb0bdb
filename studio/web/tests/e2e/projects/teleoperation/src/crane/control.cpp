#include "crane/control.hpp"

namespace teleoperation::crane::control {

void obey(Context&, const Inputs& in, Memory&, Outputs& out) { out.speed = in.lever; }

}  // namespace teleoperation::crane::control
