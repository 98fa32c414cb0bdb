#pragma once

#include <cstdint>
#include <memory>

#include "sim/simulation.hpp"
#include "tessera/device.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// kind `reflectance`: float64 or float32, 0 dark .. 1 bright, of the floor under a site. Options: `noise`
/// (standard deviation, default 0.01; 0: none) and `footprint` (diameter in m, default `footprint_m`). The
/// noise comes from `seed` and the path of the device alone. read() throws std::runtime_error once the
/// physics has failed.
[[nodiscard]] Result<std::unique_ptr<RealReceptor>> light_sensor(std::shared_ptr<Simulation> simulation,
                                                                 const DriverRequest& request,
                                                                 double footprint_m, std::uint64_t seed);

/// kind `velocity`: float64 or float32, rad/s to an actuator. Refuses what is not finite. write() throws
/// std::runtime_error once the physics has failed.
[[nodiscard]] Result<std::unique_ptr<RealEffector>> wheel(std::shared_ptr<Simulation> simulation,
                                                          const DriverRequest& request);

}  // namespace tessera::sim
