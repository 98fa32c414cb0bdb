#pragma once

#include <string>

#include "sim/engine/model.hpp"
#include "tessera/result.hpp"

namespace tessera::sim {

/// Compiles an MJCF text in memory. Files that it names are read from disk.
/// Errors: those of the engine, without a file name in front.
[[nodiscard]] Result<ModelPtr> compile_text(const std::string& mjcf);

}  // namespace tessera::sim
