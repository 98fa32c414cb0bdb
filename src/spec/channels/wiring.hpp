#pragma once

#include "spec/channels/channels.hpp"

namespace tessera::spec {

/// Checks every subsystem of every agent with the channels that lead to it and from it. If many agents of a
/// template share a mistake, it is reported once, for the first of them.
///
/// Errors:   E302 an input without source; E305 time would stand still.
/// Warnings: W316 an output without a reader; W317 an input no behaviour receives, an output no behaviour
/// sends.
void check_wiring(const Model& model, const WiringExcuses& excuses, Diagnostics& out);

}  // namespace tessera::spec
