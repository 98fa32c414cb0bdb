#include "office/control.hpp"

namespace depot::office::control {

/// Behaviour forward of office.control: the wish of the operator, for each carrier.
void forward(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.wish_0 = out.wish_1 = out.wish_2 = in.panel.valid ? Wish(in.panel) : Wish{};
}

}  // namespace depot::office::control
