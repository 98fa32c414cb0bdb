#pragma once

#include <ostream>

#include "tessera/recording.hpp"

namespace tessera::replay {

/// The run in the Trace Event Format, which ui.perfetto.dev and chrome://tracing open: a process per agent, a
/// thread per subsystem; behaviours as slices, in them the iterations (from the end of the transition
/// function to the end of the communication), messages of the log as instants,
/// numbers in buffers as counters.
///
/// Source: Trace Event Format (Google, 2016): phases X, i and M; times in microseconds.
void write_perfetto(const Recording& recording, std::ostream& to);

}  // namespace tessera::replay
