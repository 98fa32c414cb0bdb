#include "crane/cabin.hpp"

namespace teleoperation::crane::cabin {

void listen(Context&, const Inputs& in, Memory&, Outputs& out) {
  if (in.lever.valid) out.lever = in.lever;
}

}  // namespace teleoperation::crane::cabin
