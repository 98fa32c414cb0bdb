#include "office/control.hpp"

namespace depot::office::control {

/// Behaviour forward of office.control: the wish of the operator, for all carriers.
void forward(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.wish = in.panel.valid ? Wish(in.panel) : Wish{};
}

}  // namespace depot::office::control
