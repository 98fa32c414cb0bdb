#include "robot/motor.hpp"

namespace teleoperation::robot::motor {

void drive(Context&, const Inputs& in, Memory&, Outputs& out) { out.wheels = in.wheels; }

}  // namespace teleoperation::robot::motor
