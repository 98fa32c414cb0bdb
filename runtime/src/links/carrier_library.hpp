#pragma once

#include <memory>
#include <string>

#include "network/carrier.hpp"

namespace tessera {

/// Loads the library that carries messages between processes, and makes its carrier. The library stays loaded.
///
/// library: its file; empty: the one that was installed with Tessera.
/// Errors:  it cannot be loaded, offers no carrier of this version, or makes none: nullptr and `error`.
[[nodiscard]] std::unique_ptr<network::Carrier> open_carrier(const std::string& library,
                                                             const network::CarrierSetup& setup,
                                                             std::string& error);

}  // namespace tessera
