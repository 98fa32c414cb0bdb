#include "scout/control.hpp"

namespace features::scout::control {

/// Behaviour look of scout.control: answers every order.
void look(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.seen = in.order.fresh; }

}  // namespace features::scout::control
