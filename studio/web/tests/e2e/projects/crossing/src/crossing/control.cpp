#include "crossing/control.hpp"

namespace crossroads::crossing::control {
namespace {

/// Notes who gets the crossing, and says now and then how often it was lent.
void note(std::uint32_t robot, Context& context, const Inputs& in, Memory& memory) {
  memory.last = robot;
  const std::uint32_t crossings = in.back_0 + in.back_1 + 1;
  if (crossings % 1000 == 0) context.log("crossing {}", crossings);
}

}  // namespace

/// Behaviour watch of crossing.control: the conditions see who asks.
/// Reads in.request_0, in.request_1.
void watch(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}

/// Behaviour lend_0 of crossing.control: robot[0] gets the crossing. The iteration ends when it is given back.
void lend_0(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  note(0, context, in, memory);
  out.grant_0 = in.request_0;
}

/// Behaviour lend_1 of crossing.control: the same for robot[1].
void lend_1(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  note(1, context, in, memory);
  out.grant_1 = in.request_1;
}

}  // namespace crossroads::crossing::control
