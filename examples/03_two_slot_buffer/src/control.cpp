#include "watcher/control.hpp"

namespace two_slot_buffer::watcher::control {
namespace {

/// Every picture comes once, in the order in which it was taken.
void check(Context& context, const Inputs& in, Memory& memory) {
  if (!in.picture.fresh) return;  // before the first
  if (in.picture.number != memory.last + 1) {
    ++memory.missed;
    context.warn("picture {} after picture {}", in.picture.number, memory.last);
  }
  memory.last = in.picture.number;
  if (memory.last % 50 == 0) context.log("{} pictures, {} missed", memory.last, memory.missed);
}

}  // namespace

/// Behaviour look of watcher.control.
/// Reads in.picture.
void look(Context& context, const Inputs& in, Memory& memory, Outputs& out) { check(context, in, memory); }

/// Behaviour study of watcher.control: takes longer than the camera for a picture.
/// Reads in.picture.
void study(Context& context, const Inputs& in, Memory& memory, Outputs& out) { check(context, in, memory); }

}  // namespace two_slot_buffer::watcher::control
