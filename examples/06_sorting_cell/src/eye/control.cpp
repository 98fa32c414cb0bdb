#include "eye/control.hpp"

namespace sorting_cell::eye::control {

/// Behaviour watch of eye.control: a box is new when its front comes to the middle of the picture.
void watch(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const Reading& reading = in.reading;
  memory.is_new = reading.occupied && !memory.was_occupied;
  memory.was_occupied = reading.occupied;
  if (memory.is_new) out.order = {++memory.boxes, reading.red, reading.across};
}

/// Behaviour tell of eye.control: sends the order.
void tell(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}

}  // namespace sorting_cell::eye::control
