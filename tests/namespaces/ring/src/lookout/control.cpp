#include "lookout/control.hpp"

#include "say.hpp"

namespace ring::lookout::control {
namespace {

void look_at(std::uint32_t process, bool is_gone, bool& was_gone) {
  if (is_gone == was_gone) return;
  was_gone = is_gone;
  say(is_gone ? "gone" : "there", process);
}

}  // namespace

/// Behaviour look of lookout.control: says when one of the others is not heard of any more, or again.
void look(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const std::uint32_t here = context.index;
  look_at((here + 1) % 3, in.next.disconnected, memory.next_gone);
  look_at((here + 2) % 3, in.before.disconnected, memory.before_gone);
  out.here = here;
}

}  // namespace ring::lookout::control
