#pragma once

#include <string>

#include "sim/trace.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// Problem: the file cannot be read or is no trace.
[[nodiscard]] Result<Trace> read_trace(const std::string& path);

}  // namespace tessera::sim
