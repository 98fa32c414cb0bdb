#include "guard/control.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace guard::guard::control {
namespace {

enum Objection : std::uint8_t { none, no_command, too_old, too_fast, turns_too_fast };

Objection objection(const Context& context, const Inputs& in) {
  const Twist& wish = in.wish;
  if (!in.wish.valid) return no_command;
  if (1000 * tessera::seconds(in.wish.age) > context.parameters.stale) return too_old;
  if (std::hypot(wish.x, wish.y, wish.z) > context.parameters.max_linear) return too_fast;
  if (std::hypot(wish.roll, wish.pitch, wish.yaw) > context.parameters.max_angular) return turns_too_fast;
  return none;
}

/// Whether the newest command may be passed on. A new reason against it is logged once.
bool judge(Context& context, const Inputs& in, Memory& memory) {
  static constexpr std::array reasons{"", "there is no command, or more than one program gives them",
                                      "the newest command is too old", "the command is too fast",
                                      "the command turns too fast"};
  const std::uint8_t before = memory.objection;
  memory.objection = objection(context, in);
  memory.safe = memory.objection == none;
  if (memory.objection != before) {
    if (memory.safe)
      context.log("commands are passed on");
    else
      context.log("the base stands: {}", reasons[memory.objection]);
  }
  return memory.safe;
}

}  // namespace

/// Behaviour hold of guard.control: the base stands.
void hold(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  judge(context, in, memory);
  out.motion = Twist{};
}

/// Behaviour pass of guard.control. A command is judged in the iteration that would pass it on.
void pass(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  if (judge(context, in, memory))
    out.motion = in.wish;
  else
    out.motion = Twist{};
}

}  // namespace guard::guard::control
