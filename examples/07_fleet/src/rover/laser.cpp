#include "rover/laser.hpp"

namespace fleet::rover::laser {

/// Behaviour look of rover.laser: the last scan, and whether it is still valid.
void look(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.scan.ranges = in.ranges;
  out.scan.known = in.ranges.valid && in.ranges.age < std::chrono::milliseconds(150);
}

}  // namespace fleet::rover::laser
