#include "robot/console.hpp"

namespace teleoperation::robot::console {

void listen(Context&, const Inputs& in, Memory&, Outputs& out) {
  if (in.drive.valid) out.wish = in.drive;
}

}  // namespace teleoperation::robot::console
