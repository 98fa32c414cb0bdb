#pragma once

#include <memory>

#include "tessera/device.hpp"
#include "tessera/driver_setup.hpp"
#include "tessera/value_encoding.hpp"

/// Panels of operators: a driver of a receptor whose values come through the control socket
/// (tessera/monitor.hpp). Generated controllers include this file.
namespace tessera {

/// Errors: throws DriverError if the controls in the setup do not fit the type.
[[nodiscard]] std::unique_ptr<RealReceptor> make_panel(const DriverSetup& setup,
                                                       const ValueEncoding* encoding);

template <class T>
[[nodiscard]] std::unique_ptr<RealReceptor> panel_receptor(const DriverSetup& setup) {
  return make_panel(setup, value_encoding_of<T>());
}

}  // namespace tessera
