#pragma once

#include <optional>
#include <string>

#include "assembly/assembly.hpp"
#include "tessera/controller.hpp"

/// The checks of a simulated run: of its world, and of what it uses.
namespace tessera {

/// Prints the checks that have failed since the last call, and keeps them. Threads: the one that advances the
/// world.
void notice_failed_checks(Assembly& assembly);

/// Records the noticed failures that are not recorded yet, as faults of the system. Threads: that of the
/// system's lane, while no other thread notices failures.
void record_failed_checks(Assembly& assembly, Time now);

/// At the end of the run: judges the final conditions, and records everything. Returns the text that it adds
/// to the ending of the run: "; 2 checks failed: nobody touches, apart"; nullopt: none failed.
[[nodiscard]] std::optional<std::string> finish_checks(Assembly& assembly, Time now);

}  // namespace tessera
