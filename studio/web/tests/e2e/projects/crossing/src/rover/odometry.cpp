#include "rover/odometry.hpp"

namespace crossroads::rover::odometry {

/// Behaviour measure of rover.odometry: the last state of the joints, and whether it is still valid.
/// Reads in.joints.
/// Writes out.place.
void measure(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const bool known = in.joints.valid && in.joints.age < std::chrono::milliseconds(100);
  out.place = {in.joints.x, in.joints.y, in.joints.heading, known};
}

}  // namespace crossroads::rover::odometry
