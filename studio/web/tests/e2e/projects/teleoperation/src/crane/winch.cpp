#include "crane/winch.hpp"

namespace teleoperation::crane::winch {

void turn(Context&, const Inputs& in, Memory&, Outputs& out) { out.speed = in.speed; }

}  // namespace teleoperation::crane::winch
