#include "arm/control.hpp"

#include <algorithm>
#include <cmath>

#include "arm/geometry.hpp"

namespace sorting_cell::arm::control {
namespace {

// In metres. The arm looks across the belt, so its own y axis is that of the belt's way, and a box that lies
// `across` the belt is nearer to the arm by this much.
constexpr double belt_away = 0.3, top_of_box = 0.17, high = 0.26;
constexpr double bins_away = 0.31, cell_of_bin = 0.075, drop_height = 0.078;
constexpr double period_s = 0.02;
constexpr double faster = 0.1;  // in each period; a jolt tears off a box that hangs a little to one side

Tool above_belt(const Order& order, double up) { return {0, belt_away - order.across, up}; }

/// The place of the n-th box in a bin: three rows of two.
Tool in_bin(bool red, std::uint32_t n, double up) {
  const double x = (static_cast<double>(n / 2 % 3) - 1) * cell_of_bin;
  const double y = (red ? -1 : 1) * (bins_away + (static_cast<double>(n % 2) - 0.5) * cell_of_bin);
  return {std::atan2(y, x), std::hypot(x, y), up};
}

Joints joints_for(const Tool& tool) {
  const Angles angles = angles_of(tool.out, tool.up);
  return {tool.yaw, angles.shoulder, angles.elbow, angles.wrist};
}

bool near(const Joints& a, const Joints& b) {
  constexpr double enough = 0.04;
  return std::abs(a.yaw - b.yaw) < enough && std::abs(a.shoulder - b.shoulder) < enough &&
         std::abs(a.elbow - b.elbow) < enough && std::abs(a.wrist - b.wrist) < enough;
}

/// One step on the way to `goal`. Whether the arm is there, by its encoders, says memory.there; it stays
/// there for `pause` iterations.
void move(const Tool& goal, std::uint32_t pause, const Inputs& in, Memory& memory, Outputs& out) {
  Tool& at = memory.at;
  memory.pace = at == goal ? 0 : std::min(1.0, memory.pace + faster);
  const double yaw_speed = 2.5 * memory.pace, speed = 0.5 * memory.pace;
  at = {towards(goal.yaw, at.yaw, yaw_speed, period_s), towards(goal.out, at.out, speed, period_s),
        towards(goal.up, at.up, speed, period_s)};
  out.goal = joints_for(at);
  const bool known = in.joints.valid && in.joints.age < std::chrono::milliseconds(200);
  const bool arrived = at == goal && known && near(in.joints, out.goal);
  memory.ticks = arrived ? memory.ticks + 1 : 0;
  memory.there = memory.ticks > pause;
  if (memory.there) memory.ticks = 0;
}

}  // namespace

/// Behaviour wait of arm.control: the iteration ends when there is an order.
void wait(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  if (memory.at.up == 0) memory.at = {0, 0.25, high};
  out.goal = joints_for(memory.at);
  out.suction = 0;
  memory.pace = 0;
  memory.tries = 0;
}

/// Behaviour reach of arm.control: above the place where the box will stop.
void reach(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.suction = 0;
  move(above_belt(in.order, high), 0, in, memory, out);
}

/// Behaviour meet of arm.control: the iteration ends when the belt stands.
void meet(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}

/// Behaviour grip of arm.control: down to the box, and sucks.
void grip(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.suction = 1;
  move(above_belt(in.order, top_of_box - 0.004), 10, in, memory, out);
  if (memory.there) ++memory.tries;
}

/// Behaviour lift of arm.control: if nothing hangs on the cup when it is up, the behaviour fails.
void lift(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  move(above_belt(in.order, high), 6, in, memory, out);
}

/// Behaviour free of arm.control: the belt may go on.
void free(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.taken = out.taken + 1; }

/// Behaviour carry of arm.control: above the next free place of the bin.
void carry(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  move(in_bin(in.order.red, memory.sorted[in.order.red], high), 0, in, memory, out);
}

/// Behaviour lower of arm.control.
void lower(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  move(in_bin(in.order.red, memory.sorted[in.order.red], drop_height), 5, in, memory, out);
}

/// Behaviour release of arm.control: lets the box go, then goes up.
void release(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.suction = 0;
  const bool let_go = ++memory.waited > 10;
  move(in_bin(in.order.red, memory.sorted[in.order.red], let_go ? high : drop_height), 0, in, memory, out);
  memory.there = memory.there && let_go;
  if (!memory.there) return;
  memory.waited = 0;
  ++memory.sorted[in.order.red];
  context.log("box {} is in the {} bin", std::uint32_t{in.order.number}, in.order.red ? "red" : "green");
}

/// Behaviour drop of arm.control: the box has fallen off.
void drop(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.suction = 0;
  context.warn("box {} is lost", std::uint32_t{in.order.number});
}

/// Behaviour give_up of arm.control: the box goes on with the belt.
void give_up(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.suction = 0;
  out.taken = out.taken + 1;
  context.warn("box {} is given up after {} tries", std::uint32_t{in.order.number}, memory.tries);
}

}  // namespace sorting_cell::arm::control
