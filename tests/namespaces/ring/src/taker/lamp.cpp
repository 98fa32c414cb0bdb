#include "taker/lamp.hpp"

namespace ring::taker::lamp {

/// Behaviour shine of taker.lamp.
void shine(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.brightness = in.light; }

}  // namespace ring::taker::lamp
