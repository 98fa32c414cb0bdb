#include "dock/control.hpp"

namespace depot::dock::control {

/// Behaviour poll[i] of dock.control: asks carrier i.
void poll(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}

/// Behaviour lend[i] of dock.control: carrier i may enter.
void lend(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.grant[context.member] = true;
}

/// Behaviour lent[i] of dock.control: waits until carrier i gives it back.
void lent(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}

/// Behaviour free[i] of dock.control.
void free(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}

}  // namespace depot::dock::control
