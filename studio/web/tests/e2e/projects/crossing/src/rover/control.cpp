#include "rover/control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace crossroads::rover::control {
namespace {

/// Whether the rover knows where it is.
bool knows(const Inputs& in) {
  return in.place.valid && in.place.known && in.place.age < std::chrono::milliseconds(200);
}

/// How far the rover is behind the middle of the crossing on its way, in m; negative: before it.
double past_the_middle(const Place& place, const Memory& memory, double lane) {
  return memory.way * (place.x - lane);
}

double wrapped(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

/// The turn that brings it back to its lane, in rad/s.
double towards_the_lane(const Place& place, double way) {
  const double ahead = way > 0 ? 0 : std::numbers::pi;
  return std::clamp(-4 * way * place.y - 3 * wrapped(place.heading - ahead), -2.0, 2.0);
}

/// Drives along the lane to `goal`, in m past the middle, and stops there or drives on. A rover that does not
/// know where it is stands still, and has not arrived.
void drive_to(double goal, bool stops, Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = {0, 0};
  memory.to_go = std::numeric_limits<double>::infinity();
  if (!knows(in)) return;
  memory.to_go = goal - past_the_middle(in.place, memory, context.parameters.lane);
  if (stops && memory.to_go <= 0) return;
  const double speed = context.parameters.speed;
  out.motion.ahead = stops ? std::min(speed, 3 * memory.to_go + 0.05) : speed;
  out.motion.turn = towards_the_lane(in.place, memory.way);
}

}  // namespace

/// Behaviour approach of rover.control: to the stop line. There it takes the next number, which the behaviours
/// wait and give_back send: if one of them fails, Tessera sends the same number for it.
void approach(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  drive_to(-context.parameters.stop, true, context, in, memory, out);
  if (memory.to_go <= 0) out.request = out.back = ++memory.crossings;
}

/// Behaviour wait of rover.control: stands still and asks. The iteration ends when the grant has come.
void wait(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.motion = {0, 0}; }

/// Behaviour cross of rover.control: as far behind the middle as the stop line is before it.
void cross(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  drive_to(context.parameters.stop, false, context, in, memory, out);
}

/// Behaviour give_back of rover.control: it has left the crossing.
void give_back(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}

/// Behaviour leave of rover.control: to the end of the lane.
void leave(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  drive_to(context.parameters.lane, true, context, in, memory, out);
  if (memory.to_go <= 0) {
    memory.way = -memory.way;
    memory.to_turn = std::numbers::pi;
  }
}

/// Behaviour turn of rover.control: on the spot, until it looks the other way.
void turn(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = {0, 0};
  if (!knows(in)) return;
  memory.to_turn = std::abs(wrapped(in.place.heading - (memory.way > 0 ? 0 : std::numbers::pi)));
  out.motion.turn = memory.to_turn > 0.1 ? std::clamp(3 * memory.to_turn, 0.3, 2.5) : 0;
}

}  // namespace crossroads::rover::control
