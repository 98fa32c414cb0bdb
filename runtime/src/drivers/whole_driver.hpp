#pragma once

#include <memory>
#include <vector>

#include "tessera/device.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// Makes one device per real buffer for a driver that serves all real buffers of a subsystem. The driver is
/// read once per iteration, when the first buffer is read. It is written once, when the last buffer of a
/// command is written. The data behind `bindings.real` must outlive the devices.
[[nodiscard]] std::vector<std::unique_ptr<RealReceptor>> parts_of(std::unique_ptr<RealReceptor> driver,
                                                                  const Bindings& bindings);
[[nodiscard]] std::vector<std::unique_ptr<RealEffector>> parts_of(std::unique_ptr<RealEffector> driver,
                                                                  const Bindings& bindings);

}  // namespace tessera
