#include "guard/base.hpp"
#include "guard/ears.hpp"

namespace guard::guard {

/// Behaviour listen of guard.ears.
void ears::listen(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.wish = in.wish; }

/// Behaviour drive of guard.base.
void base::drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  out.command = in.motion;
}

}  // namespace guard::guard
