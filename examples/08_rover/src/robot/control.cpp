#include "robot/control.hpp"

#include <algorithm>

#include "robot/room.hpp"

namespace scout::robot::control {
namespace {

/// The free space in the scan; no space is free if there is no scan, or an old one.
Room look(const Context& context, const Inputs& in) {
  const bool known = in.scan.valid && in.scan.known && in.scan.age < std::chrono::milliseconds(300);
  if (!known) return {};
  return room_around(in.scan.ranges, context.parameters.gap);
}

}  // namespace

/// Behaviour drive of robot.control: ahead, slower before something.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const Room room = look(context, in);
  memory.free = room.free_m;
  const double speed = std::clamp(1.5 * room.free_m, 0.0, double{context.parameters.speed});
  out.motion = {speed, 0.3 * std::clamp(room.left_m - room.right_m, -1.0, 1.0)};
  if (memory.free <= 0) memory.side = room.left_m >= room.right_m ? 1 : -1;
}

/// Behaviour avoid of robot.control: turns until there is room ahead.
void avoid(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  memory.free = look(context, in).free_m;
  out.motion = {0, 1.5 * memory.side};
}

}  // namespace scout::robot::control
