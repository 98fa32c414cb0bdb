#include "belt/barrier.hpp"

namespace sorting_cell::belt::barrier {

/// Behaviour look of belt.barrier: whether something stands between the lamp and the other side of the belt.
void look(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  constexpr double across_m = 0.25;
  out.blocked = in.distance.valid && in.distance < across_m;
}

}  // namespace sorting_cell::belt::barrier
