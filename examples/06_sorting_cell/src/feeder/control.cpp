#include "feeder/control.hpp"

namespace sorting_cell::feeder::control {

/// Behaviour wait of feeder.control: stands. The iteration ends when the belt allows another box.
void wait(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.speed = 0; }

/// Behaviour bring of feeder.control: goes on while the belt runs, until enough boxes have passed the gate.
void bring(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.speed = in.belt_runs && in.passed < in.allowed ? context.parameters.belt_speed : 0;
}

}  // namespace sorting_cell::feeder::control
