#pragma once

namespace features {

/// Iterations of `walk` behind one of `rest`, by all walkers of a simulation.
inline int walks_after_a_rest = 0;

}  // namespace features
