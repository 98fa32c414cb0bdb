#include "giver/control.hpp"

#include "say.hpp"

namespace ring::giver::control {

/// Behaviour give of giver.control: gives the next item, and reports the fate of the last one.
void give(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const std::uint32_t giver = context.index;
  if (memory.number == 0)
    memory.start = static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  else
    say(out.item.timed_out ? "gave_up" : "confirmed", giver, memory.start, memory.number);
  out.item = {giver, memory.start, ++memory.number};
}

}  // namespace ring::giver::control
