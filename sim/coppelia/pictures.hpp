#pragma once

#include <memory>

#include "sim/coppelia/devices.hpp"

/// The pictures of vision sensors. The vision sensor decides the number of pixels. The makers throw
/// sim::DeviceError.
namespace tessera::coppelia {

/// Red, green and blue of each pixel, rows from the top.
[[nodiscard]] std::unique_ptr<RealReceptor> camera(const DeviceContext& context,
                                                   const DriverRequest& request);
/// Distance in metres of each pixel, rows from the top.
[[nodiscard]] std::unique_ptr<RealReceptor> depth(const DeviceContext& context, const DriverRequest& request);

}  // namespace tessera::coppelia
