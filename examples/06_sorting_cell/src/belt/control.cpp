#include "belt/control.hpp"

namespace sorting_cell::belt::control {
namespace {

/// The largest number of boxes on the belt at a time, so that no more than two orders wait for the arm.
constexpr std::uint32_t most_boxes = 2;

void move(bool runs, const Context& context, Outputs& out) {
  out.speed = runs ? context.parameters.belt_speed : 0;
  out.runs = runs;
}

}  // namespace

/// Behaviour clear of belt.control: runs until nothing is before the arm, and allows the feeder one more box.
void clear(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.allowed = memory.boxes + most_boxes;
  move(true, context, out);
}

/// Behaviour run of belt.control: until the next box is before the arm.
void run(Context& context, const Inputs& in, Memory& memory, Outputs& out) { move(true, context, out); }

/// Behaviour hold of belt.control: stands, and tells the arm. The iteration ends when the box is gone.
void hold(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  move(false, context, out);
  out.arrived = ++memory.boxes;
}

}  // namespace sorting_cell::belt::control
