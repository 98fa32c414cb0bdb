#include "robot/arm.hpp"

namespace safety::robot::arm {

void move(Context&, const Inputs& in, Memory&, Outputs& out) { out.joint = in.velocity.speed; }

}  // namespace safety::robot::arm
