#include "base/lidar.hpp"

namespace features::base::lidar {

/// Behaviour scan of base.lidar.
void scan(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.ranges = in.ranges; }

}  // namespace features::base::lidar
