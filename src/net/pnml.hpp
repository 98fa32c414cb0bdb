#pragma once

#include <string>

#include "net/net.hpp"

namespace tessera::net {

struct PnmlOptions {
  std::string name = "net";  ///< of the net
};

/// The net as a P/T net of ISO/IEC 15909-2 that other model checkers load. It has one page, and elements
/// p0.. and t0.. in the order of the net (arcs a0..), with their paths as names. Conditions are left out,
/// so every transition with a condition is a free choice.
///
/// UTF-8; characters that XML 1.0 cannot hold become '?'. Linear in the net.
[[nodiscard]] std::string to_pnml(const Net& net, const PnmlOptions& options = {});

}  // namespace tessera::net
