#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "sim/simulation.hpp"
#include "tessera/device.hpp"

namespace tessera::sim {

/// kind `reflectance`: float64 or float32, 0 dark .. 1 bright, of the floor under a site. Options: `noise`
/// (standard deviation, default 0.01; 0: none) and `footprint` (diameter in m, default `footprint_m`).
/// The noise depends only on `seed` and the path of the device. read() throws std::runtime_error
/// once the physics has failed.
[[nodiscard]] std::unique_ptr<RealReceptor> light_sensor(std::shared_ptr<Simulation> simulation,
                                                         const DriverRequest& request, double footprint_m,
                                                         std::uint64_t seed, std::string& error);

/// kind `velocity`: float64 or float32, rad/s to an actuator. Refuses values that are not finite. write()
/// throws std::runtime_error once the physics has failed.
[[nodiscard]] std::unique_ptr<RealEffector> wheel(std::shared_ptr<Simulation> simulation,
                                                  const DriverRequest& request, std::string& error);

}  // namespace tessera::sim
