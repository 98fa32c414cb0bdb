#include "carrier/control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depot::carrier::control {
namespace {

constexpr double charge_per_s = 0.25, use_per_m = 0.25;
constexpr double period_s = 0.05;  // of control

/// Whether the carrier knows where it is.
bool knows(const Inputs& in) {
  return in.place.valid && in.place.known && in.place.age < std::chrono::milliseconds(200);
}

bool is_paused(const Inputs& in) { return in.wish.valid && in.wish.pause; }

/// Drives forwards or backwards to `goal`, in m from where it started, and stops there. It looks towards the dock
/// all the time. A carrier that does not know where it is, or that is paused, stands still and has not arrived.
void drive_to(double goal, const Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = {0, 0};
  memory.to_go = std::numeric_limits<double>::infinity();
  if (!knows(in) || is_paused(in)) return;
  const double ahead = goal - in.place.x;
  memory.to_go = std::abs(ahead) - 0.02;
  if (memory.to_go <= 0) return;
  const double speed = context.parameters.speed;
  out.motion.ahead = std::copysign(std::min(speed, 3 * std::abs(ahead) + 0.02), ahead);
  const double way = ahead > 0 ? 1 : -1;
  out.motion.turn = std::clamp(-4 * way * in.place.y - 3 * in.place.heading, -2.0, 2.0);
  memory.charge = std::max(memory.charge - use_per_m * std::abs(out.motion.ahead) * period_s, 0.0);
}

double line_of(const Context& context) { return context.parameters.dock - context.parameters.line; }

}  // namespace

/// Behaviour work of carrier.control: to and fro, until the battery is low.
void work(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  drive_to(memory.way > 0 ? line_of(context) : 0, context, in, memory, out);
  if (memory.to_go <= 0) memory.way = -memory.way;
}

/// Behaviour to_line of carrier.control: to where it waits.
void to_line(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  drive_to(line_of(context), context, in, memory, out);
}

/// Behaviour ask of carrier.control: stands still and asks for the dock.
void ask(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = {0, 0};
  out.request = true;
}

/// Behaviour queue of carrier.control: another one is at the dock.
void queue(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.motion = {0, 0}; }

/// Behaviour enter of carrier.control: into the dock.
void enter(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  drive_to(context.parameters.dock, context, in, memory, out);
}

/// Behaviour charge of carrier.control.
void charge(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = {0, 0};
  memory.charge += charge_per_s * period_s;
}

/// Behaviour leave of carrier.control: back to the line.
void leave(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  drive_to(line_of(context), context, in, memory, out);
}

/// Behaviour give_back of carrier.control: it has left the dock.
void give_back(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.motion = {0, 0};
  out.back = true;
}

/// Behaviour safe of carrier.control: stands still. A dock in which it stands is not given back.
void safe(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.motion = {0, 0}; }

}  // namespace depot::carrier::control
