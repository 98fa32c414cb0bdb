#include "sim/judging/line_follower.hpp"

#include <cmath>
#include <stdexcept>

namespace tessera::sim {

void LineFollower::look(const Physics& physics, const Eyes& eyes) {
  const std::optional<Eyes::Look> look = eyes.look(physics, robot_);
  if (!look)
    throw std::runtime_error("'" + name_ + "' has no light sensor (`reflectance`), so it follows no line");
  const double now_s = seconds(physics.time());
  // The same rule as for the figures of the whole run: a look stands for the time up to the next one.
  if (!was_on_line_) seen_.lost_s += now_s - looked_at_s_;
  if (look->on_line) seen_.lost_s = 0;
  was_on_line_ = look->on_line;
  looked_at_s_ = now_s;
  seen_.error_m = std::abs(way_.next(look->middle).left_m);
  seen_.laps = std::abs(way_.progress_m()) / way_.length_m();
}

}  // namespace tessera::sim
