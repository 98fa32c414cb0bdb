#include "rover/laser.hpp"

namespace fleet::rover::laser {

/// Behaviour look of rover.laser. Before the first scan nothing is known, and nothing is sent as free.
void look(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  if (in.ranges.valid) out.scan.ranges = in.ranges;
}

}  // namespace fleet::rover::laser
