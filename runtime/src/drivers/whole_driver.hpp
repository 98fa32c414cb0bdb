#pragma once

#include <memory>
#include <vector>

#include "tessera/device.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// One device per real buffer, for a driver that serves all real buffers of a subsystem. The driver is read
/// once an iteration, with the first buffer that is asked for; it is written once, with the last buffer of
/// the command. What is behind `bindings.real` must outlive them.
[[nodiscard]] std::vector<std::unique_ptr<RealReceptor>> parts_of(std::unique_ptr<RealReceptor> driver,
                                                                  const Bindings& bindings);
[[nodiscard]] std::vector<std::unique_ptr<RealEffector>> parts_of(std::unique_ptr<RealEffector> driver,
                                                                  const Bindings& bindings);

}  // namespace tessera
