#pragma once

#include <ostream>

#include "tessera/recording.hpp"

namespace tessera::replay {

/// Writes the run in the Trace Event Format, which ui.perfetto.dev and chrome://tracing open. Each agent is
/// a process, each subsystem a thread. Behaviours are slices, which contain the iterations (from the end of
/// the transition function to the end of the communication). Messages of the log are instants, numbers in
/// buffers are counters.
///
/// Source: Trace Event Format (Google, 2016): phases X, i and M; times in microseconds.
void write_perfetto(const Recording& recording, std::ostream& to);

}  // namespace tessera::replay
