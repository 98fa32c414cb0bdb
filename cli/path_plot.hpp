#pragma once

#include <string>

#include "sim/track.hpp"

namespace tessera::cli {

/// Draws the robot's path over the floor in braille characters, eight dots each, for a terminal.
[[nodiscard]] std::string path_plot(const sim::Track& floor, const sim::Trace& trace);

}  // namespace tessera::cli
