#include "feeder/gate.hpp"

namespace sorting_cell::feeder::gate {

/// Behaviour look of feeder.gate: counts what comes between the lamp and the other side of the belt.
void look(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  constexpr double across_m = 0.25;
  const bool blocked = in.distance.valid && in.distance < across_m;
  if (blocked && !memory.was_blocked) out.passed = out.passed + 1;
  memory.was_blocked = blocked;
}

}  // namespace sorting_cell::feeder::gate
