#include "base/control.hpp"

namespace features::base::control {

/// Behaviour listen of base.control: sends everybody to the wall.
void listen(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.order = {1, 2, 0.5};
  const std::size_t steps = in.report.way.size();
  const bool agree = in.report.cloud.size() == 500 * steps;
  out.move = {in.ranges[0], in.report.samples[7], agree ? static_cast<double>(steps) : -1};
}

}  // namespace features::base::control
