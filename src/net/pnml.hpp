#pragma once

#include <string>

#include "net/net.hpp"

namespace tessera::net {

struct PnmlOptions {
  std::string name = "net";  ///< of the net
};

/// The net as a P/T net of ISO/IEC 15909-2, as other checkers load it: one page, elements p0.. and t0.. in
/// the order of the net (arcs a0..), their paths as names. Conditions are left out, so transitions with one
/// are free choices.
///
/// UTF-8; characters that XML 1.0 cannot hold become '?'. Linear in the net.
[[nodiscard]] std::string to_pnml(const Net& net, const PnmlOptions& options = {});

}  // namespace tessera::net
