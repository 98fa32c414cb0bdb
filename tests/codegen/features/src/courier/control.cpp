#include "courier/control.hpp"

#include "errands.hpp"

namespace features::courier::control {

/// Behaviour go of courier.control: what it writes into the fields of the controller has no effect.
void go(Context&, const Inputs&, Memory&, Outputs& out) {
  out.errand.x = 1;
  out.errand.call += 1000;
  out.errand.cancel = true;
}

/// Behaviour arrive of courier.control.
void arrive(Context&, const Inputs&, Memory& memory, Outputs& out) {
  ends_of_errands.push_back({"arrive", out.errand.call, std::string(memory.going.view()), out.errand.cancel});
}

/// Behaviour report of courier.control.
void report(Context&, const Inputs&, Memory& memory, Outputs& out) {
  ends_of_errands.push_back({"report", out.errand.call, std::string(memory.going.view()), out.errand.cancel});
}

/// Behaviour stop of courier.control.
void stop(Context& context, const Inputs&, Memory& memory, Outputs& out) {
  if (context.in_behaviour == tessera::Duration::zero())
    ends_of_errands.push_back({"stop", out.errand.call, std::string(memory.going.view()), out.errand.cancel});
}

}  // namespace features::courier::control
