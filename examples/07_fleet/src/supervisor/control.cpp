#include "supervisor/control.hpp"

namespace fleet::supervisor::control {

/// Behaviour rest of supervisor.control: lets the rovers drive.
void rest(Context& context, const Inputs& in, Memory& memory, Outputs& out) { ++memory.seconds; }

/// Behaviour call of supervisor.control: all rovers stop. The iteration ends when the last one is counted.
void call(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  memory.seconds = 0;
  out.call = ++memory.calls;
  out.count = {0, 0};
}

/// Behaviour report of supervisor.control.
void report(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  context.log("roll call {}: {} rovers, {:.1f} m driven", memory.calls, in.total.rovers, in.total.driven);
}

}  // namespace fleet::supervisor::control
