#include "dock/control.hpp"

namespace depot::dock::control {
void poll_0(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void poll_1(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void poll_2(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void lend_0(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.grant_0 = true; }
void lend_1(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.grant_1 = true; }
void lend_2(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.grant_2 = true; }
void lent_0(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void lent_1(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void lent_2(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void free_0(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void free_1(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
void free_2(Context& context, const Inputs& in, Memory& memory, Outputs& out) {}
}  // namespace depot::dock::control
