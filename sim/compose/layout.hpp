#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/compose/placement.hpp"
#include "tessera/result.hpp"

/// Layouts of many placements.
namespace tessera::sim {

/// Rows along x: the first placement in the corner, the next `spacing_m` beside it; after `columns` of them,
/// a new row `spacing_m` farther along y.
struct Grid {
  double x_m = 0, y_m = 0, z_m = 0;
  std::size_t columns = 1;
  double spacing_m = 1;
};

/// Puts the placements on the grid in their order; headings are kept.
/// Errors: no columns; a spacing that is not positive; a corner that is not finite.
[[nodiscard]] Result<std::vector<Placement>> on_grid(const Grid& grid, std::vector<Placement> placements);

/// Draws a position for each placement from the volume of a site of the world (box, cylinder, sphere,
/// ellipsoid or capsule), evenly. Any two are at least `apart_m` from each other, from origin to origin. The
/// x, y and z of a placement are added to the drawn position: a z_m of 0.05 puts a rover on its wheels if the
/// site lies flat on the floor.
///
/// The same seed gives the same positions, on every machine.
///
/// Errors: there is no such site ("the world has: ..."), the placements do not fit, a distance is negative or
/// not finite, or the world file is wrong.
[[nodiscard]] Result<std::vector<Placement>> scatter(const std::string& world_file, const std::string& site,
                                                     double apart_m, std::uint64_t seed,
                                                     std::vector<Placement> placements);

}  // namespace tessera::sim
