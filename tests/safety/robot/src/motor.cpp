#include "robot/motor.hpp"

#include "harm.hpp"

namespace safety::robot::motor {

void drive(Context&, const Inputs& in, Memory&, Outputs& out) {
  suffer(command_log::Place::motor);
  out.left = out.right = in.velocity.speed;
}

}  // namespace safety::robot::motor
