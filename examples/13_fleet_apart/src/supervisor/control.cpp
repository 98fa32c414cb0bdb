#include "supervisor/control.hpp"

namespace convoy::supervisor::control {
namespace {

constexpr double period_s = 0.05;  // 20 Hz

void lead_at(double speed, Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  constexpr std::uint64_t every = 100;
  if (context.iteration % every == 0)
    context.log("{:.1f} m led, the convoy is {:.1f} m long", memory.at, memory.length);
  memory.at += speed * period_s;
  if (in.last.valid) memory.length = memory.at - in.last.at;
  out.lead = {memory.at, speed};
  out.go = !in.last.disconnected;
}

}  // namespace

/// Behaviour lead of supervisor.control: the point that the first rover follows moves on.
void lead(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  lead_at(context.parameters.pace, context, in, memory, out);
}

/// Behaviour wait of supervisor.control: the point stands until the last rover is heard of and near.
void wait(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  lead_at(0, context, in, memory, out);
}

}  // namespace convoy::supervisor::control
