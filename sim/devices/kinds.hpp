#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/devices/device_error.hpp"
#include "sim/devices/writers.hpp"
#include "sim/rendering/renderer.hpp"
#include "sim/simulation.hpp"
#include "tessera/device.hpp"

/// The devices of simulated worlds (docs/use/worlds.md describes the kinds).
///
/// A new kind is one function that makes it, and a row in kinds.cpp. The specification also needs its name
/// (src/spec/devices/world_kinds.cpp).
namespace tessera::sim {

/// The state that devices share.
struct DeviceContext {
  std::shared_ptr<Simulation> simulation;
  double footprint_m = 0.008;
  std::uint64_t seed = 1;
  std::shared_ptr<Renderer> renderer{};  ///< for the cameras
  std::shared_ptr<Writers> writers = std::make_shared<Writers>();
};

/// Make the device that the request asks for. Throw DeviceError if the world has no such element or it does
/// not fit the buffer.
[[nodiscard]] std::unique_ptr<RealReceptor> make_receptor(const DeviceContext& context,
                                                          const DriverRequest& request);
[[nodiscard]] std::unique_ptr<RealEffector> make_effector(const DeviceContext& context,
                                                          const DriverRequest& request);

// The makers of the kinds, by source file. Errors: DeviceError.

// reflectance.cpp
/// Brightness of the floor under a site: 0 dark .. 1 bright.
[[nodiscard]] std::unique_ptr<RealReceptor> reflectance(const DeviceContext& context,
                                                        const DriverRequest& request);
// readings.cpp
[[nodiscard]] std::unique_ptr<RealReceptor> joint_position(const DeviceContext& context,
                                                           const DriverRequest& request);
[[nodiscard]] std::unique_ptr<RealReceptor> joint_velocity(const DeviceContext& context,
                                                           const DriverRequest& request);
[[nodiscard]] std::unique_ptr<RealReceptor> pose(const DeviceContext& context, const DriverRequest& request);
// sensors.cpp
[[nodiscard]] std::unique_ptr<RealReceptor> sensor(const DeviceContext& context,
                                                   const DriverRequest& request);
// contact.cpp
[[nodiscard]] std::unique_ptr<RealReceptor> contact(const DeviceContext& context,
                                                    const DriverRequest& request);
// scan.cpp
[[nodiscard]] std::unique_ptr<RealReceptor> scan(const DeviceContext& context, const DriverRequest& request);
// pictures.cpp
[[nodiscard]] std::unique_ptr<RealReceptor> camera(const DeviceContext& context,
                                                   const DriverRequest& request);
[[nodiscard]] std::unique_ptr<RealReceptor> depth(const DeviceContext& context, const DriverRequest& request);
[[nodiscard]] std::unique_ptr<RealReceptor> labels(const DeviceContext& context,
                                                   const DriverRequest& request);
// commands.cpp
[[nodiscard]] std::unique_ptr<RealEffector> actuator(const DeviceContext& context,
                                                     const DriverRequest& request);
[[nodiscard]] std::unique_ptr<RealEffector> colour(const DeviceContext& context,
                                                   const DriverRequest& request);
// movements.cpp
[[nodiscard]] std::unique_ptr<RealEffector> weld(const DeviceContext& context, const DriverRequest& request);
[[nodiscard]] std::unique_ptr<RealEffector> mocap(const DeviceContext& context, const DriverRequest& request);
[[nodiscard]] std::unique_ptr<RealEffector> place(const DeviceContext& context, const DriverRequest& request);

}  // namespace tessera::sim
