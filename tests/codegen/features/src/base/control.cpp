#include "base/control.hpp"

namespace features::base::control {

/// Behaviour listen of base.control: sends everybody to the wall.
void listen(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.order = {1, 2, 0.5};
  out.move = {in.ranges[0], in.report.samples[7], 0};
}

}  // namespace features::base::control
