#pragma once

#include "assembly/assembly.hpp"
#include "tessera/controller.hpp"

/// The checks of a simulated world during a run.
namespace tessera {

/// Prints the checks that have failed meanwhile and keeps them. Threads: the one that advances the world.
void notice_failed_checks(Assembly& assembly);

/// Records what was noticed and is not recorded yet, as faults of the system. Threads: the one of the system's
/// lane, while no other thread notices.
void record_failed_checks(Assembly& assembly, Time now);

/// At the end of the run: judges what holds then, and records all. Returns what it adds to the ending of the
/// run: "; 2 checks failed: nobody touches, apart"; empty: none failed.
[[nodiscard]] std::string finish_checks(Assembly& assembly, Time now);

}  // namespace tessera
