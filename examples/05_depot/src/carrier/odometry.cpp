#include "carrier/odometry.hpp"

namespace depot::carrier::odometry {

/// Behaviour measure of carrier.odometry: the last state of the joints, and whether it is still valid.
/// Reads in.joints.
/// Writes out.place.
void measure(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const bool known = in.joints.valid && in.joints.age < std::chrono::milliseconds(100);
  out.place = {in.joints.x, in.joints.y, in.joints.heading, known};
}

}  // namespace depot::carrier::odometry
