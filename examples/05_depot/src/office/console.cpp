#include "office/console.hpp"

namespace depot::office::console {

/// Behaviour read of office.console.
void read(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  if (in.panel.valid) out.wish = in.panel;
}

}  // namespace depot::office::console
