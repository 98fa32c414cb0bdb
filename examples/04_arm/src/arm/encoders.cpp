#include "arm/encoders.hpp"

namespace cell::arm::encoders {

/// Behaviour measure of arm.encoders.
/// Reads in.q1 .. in.q6.
/// Writes out.now.
void measure(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.now.position = {in.q1, in.q2, in.q3, in.q4, in.q5, in.q6};
}

}  // namespace cell::arm::encoders
