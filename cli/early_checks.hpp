#pragma once

#include "project/launch.hpp"

namespace tessera::cli {

/// Whether a run can begin as it is asked for, as far as the specification tells: the files of the world, the
/// parameters and the times of the command line. Asked before anything is built, in the words of the
/// controller. A specification that cannot be read passes; whoever reads it says why.
///
/// with_world: the run is in the simulated world.
[[nodiscard]] bool can_run(const project::LaunchOptions& options, bool with_world);

}  // namespace tessera::cli
