#include "watcher/camera.hpp"

#include <cmath>

namespace two_slot_buffer::watcher::camera {

/// Behaviour take of watcher.camera: day and night in two minutes.
/// Writes out.picture.
void take(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  ++memory.taken;
  out.picture = {memory.taken, 0.5 + 0.5 * std::sin(memory.taken * 0.005)};
}

}  // namespace two_slot_buffer::watcher::camera
