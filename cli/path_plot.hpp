#pragma once

#include <string>

#include "cli/launch.hpp"
#include "sim/trace.hpp"

namespace tessera::cli {

/// The robot's path over the floor as lines of braille characters, eight dots each, for a terminal without a display.
/// Empty when the picture cannot be read.
[[nodiscard]] std::string path_plot(const Floor& floor, const sim::Trace& trace);

}  // namespace tessera::cli
