#include "cart/control.hpp"

#include <algorithm>

#include "filter.hpp"

namespace approach::cart::control {

namespace {

constexpr double range_deviation_m = 0.05, acceleration = 2;

void estimate(const Context& context, const Inputs& in, Memory& memory) {
  Filter filter(memory.state, memory.covariance);
  if (!memory.known && in.range.valid) memory.state[0] = in.range;
  memory.known = memory.known || in.range.valid;
  if (!memory.known) return;
  filter.predict(tessera::seconds(context.period), acceleration);
  if (in.range.fresh) filter.correct(in.range, range_deviation_m);
}

}  // namespace

void approach(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  estimate(context, in, memory);
  const double left = memory.state[0] - context.parameters.gap;
  out.speed = memory.known ? std::min(context.parameters.speed, std::max(left, 0.05)) : 0;
}

void stay(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  estimate(context, in, memory);
  out.speed = 0;
}

}  // namespace approach::cart::control
