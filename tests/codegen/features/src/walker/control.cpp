#include "walker/control.hpp"

#include <algorithm>

#include "walks.hpp"

namespace features::walker::control {

/// Behaviour rest of walker.control: passes the token on.
void rest(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  if (in.token.fresh) out.token = in.token + 1;
  ++memory.count;
  memory.rested = true;
}

/// Behaviour walk of walker.control: reports where it is.
void walk(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  if (memory.rested) ++walks_after_a_rest;
  std::rotate(memory.history.begin(), memory.history.begin() + 1, memory.history.end());
  memory.history.back() = in.order.x;
  memory.count = static_cast<std::uint8_t>(memory.count % 9 + 1);
  out.token += 1;
  out.report.pose[0] = in.order;
  out.report.way.clear();
  for (std::uint8_t step = 0; step < memory.count % 6; ++step) out.report.way.push_back(in.order);
  out.report.cloud.resize(out.report.way.size() * 500);
  out.report.text = context.parameters.label.view();
  out.report.samples.fill(context.parameters.gain);
  out.report.all.e = context.parameters.limit;
}

}  // namespace features::walker::control
