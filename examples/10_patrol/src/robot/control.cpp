#include "robot/control.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace roamer::robot::control {
namespace {

/// The nearest thing within 60 degrees of straight ahead; nothing is free without a scan, or with an old one.
double free_ahead_m(const Inputs& in) {
  if (!in.seen.valid || !in.seen.known || in.seen.age > std::chrono::milliseconds(300)) return 0;
  const Scan& scan = in.seen.scan;
  double free_m = scan.range_max;
  for (std::size_t ray = 0; ray < scan.ranges.size(); ++ray) {
    const double angle_rad =
        (2 * static_cast<double>(ray) / static_cast<double>(scan.ranges.size()) - 1) * std::numbers::pi;
    const double range_m = scan.ranges[ray];
    // Rays that hit nothing are infinite.
    if (std::abs(angle_rad) < std::numbers::pi / 3 && std::isfinite(range_m))
      free_m = std::min(free_m, range_m);
  }
  return free_m;
}

}  // namespace

/// Behaviour drive of robot.control: ahead, as long as there is room.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  memory.free = free_ahead_m(in);
  const bool room = memory.free >= context.parameters.gap;
  out.motion = {room ? double{context.parameters.speed} : 0.0, 0};
}

/// Behaviour turn of robot.control: on the spot, until there is room ahead. Without a scan the robot stands.
void turn(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  memory.free = free_ahead_m(in);
  out.motion = {0, memory.free > 0 ? 0.8 : 0.0};
}

}  // namespace roamer::robot::control
