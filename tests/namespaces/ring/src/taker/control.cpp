#include "taker/control.hpp"

#include "say.hpp"

namespace ring::taker::control {

/// Behaviour take of taker.control.
void take(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  if (!in.item.fresh) return;
  say("took", in.item.giver, in.item.start, in.item.number);
  out.light = in.item.number;
}

}  // namespace ring::taker::control
