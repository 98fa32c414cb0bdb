#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tessera/result.hpp"

namespace tessera::sim {

/// A quantity of a placed model that differs from run to run: `vary: { box.mass: [0.04, 0.06] }`.
struct Variation {
  std::string instance;  ///< "box[3]"
  std::string what;      ///< "box.mass": an element of the model, and a quantity
  double least = 0, most = 0;
};

/// Draws each value evenly from the seed, and changes the model. Quantities: `mass` of a body in kg, with its
/// inertia in proportion; `friction` of a geom, the sliding one; `damping` of a joint, all its axes.
///
/// The value depends only on the seed, the instance and the name, so another variation does not change it.
///
/// Problem: no such element or quantity, or a value that is not positive (mass) or negative.
[[nodiscard]] std::optional<Problem> vary(mjModel& model, const std::vector<Variation>& variations,
                                          std::uint64_t seed);

}  // namespace tessera::sim
