#include "eye/camera.hpp"

#include "eye/picture.hpp"

namespace sorting_cell::eye::camera {

/// Behaviour look of eye.camera: the box in the middle of the picture, if there is one.
void look(Context& context, const Inputs& in, Memory& memory, Outputs& out) {
  const Sight sight = middle_of_picture({in.picture.data(), in.picture.size()});
  out.reading = {sight.occupied, sight.red, sight.across_m};
}

}  // namespace sorting_cell::eye::camera
