#include "rover/control.hpp"

#include <algorithm>

namespace convoy::rover::control {
namespace {

constexpr double period_s = 0.05;       // 20 Hz
constexpr double start_distance_m = 2;  // from one rover to the next, at the start

void drive(const Context& context, Memory& memory, Outputs& out, double speed) {
  memory.driven += speed * period_s;
  out.speed = speed;
  out.state = {memory.driven - start_distance_m * (context.index + 1), speed};
}

}  // namespace

/// Behaviour follow of rover.control: the faster, the further the one ahead is away.
void follow(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const double at = memory.driven - start_distance_m * (context.index + 1);
  const double room = in.ahead.valid ? in.ahead.at - at - context.parameters.gap : 0;
  drive(context, memory, out, std::clamp(room, 0.0, double{context.parameters.speed}));
}

/// Behaviour stand of rover.control.
void stand(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  drive(context, memory, out, 0);
}

}  // namespace convoy::rover::control
