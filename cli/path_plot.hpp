#pragma once

#include <string>

#include "sim/track.hpp"

namespace tessera::cli {

/// The robot's path over the floor as lines of braille characters, eight dots each, for a terminal without a
/// display.
[[nodiscard]] std::string path_plot(const sim::Track& floor, const sim::Trace& trace);

}  // namespace tessera::cli
