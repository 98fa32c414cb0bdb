#pragma once

#include <memory>

#include "sim/coppelia/devices.hpp"

/// The pictures of vision sensors. The vision sensor decides how many pixels there are. Throw
/// sim::DeviceError.
namespace tessera::coppelia {

/// Red, green and blue of each pixel, rows from the top.
[[nodiscard]] std::unique_ptr<RealReceptor> camera(const DeviceContext& context,
                                                   const DriverRequest& request);
/// Metres, rows from the top.
[[nodiscard]] std::unique_ptr<RealReceptor> depth(const DeviceContext& context, const DriverRequest& request);

}  // namespace tessera::coppelia
