#pragma once

#include <cstdint>
#include <memory>

#include "sim/coppelia/lock_step.hpp"
#include "sim/devices/writers.hpp"
#include "tessera/device.hpp"

namespace tessera::coppelia {

/// The state that devices share.
struct DeviceContext {
  std::shared_ptr<LockStep> scene;  ///< nullptr: devices are only judged, without a server
  std::uint64_t seed = 1;
  std::shared_ptr<sim::Writers> writers = std::make_shared<sim::Writers>();
};

/// Make the device that the request asks for (docs/use/worlds.md). Throw sim::DeviceError if CoppeliaSim has no
/// such kind, the scene no such object, or it does not fit the buffer.
[[nodiscard]] std::unique_ptr<RealReceptor> make_receptor(const DeviceContext& context,
                                                          const DriverRequest& request);
[[nodiscard]] std::unique_ptr<RealEffector> make_effector(const DeviceContext& context,
                                                          const DriverRequest& request);

}  // namespace tessera::coppelia
