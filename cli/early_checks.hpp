#pragma once

#include "project/launch.hpp"

namespace tessera::cli {

/// `ok`, or the exit code of a run that cannot begin as it is asked for, as far as the specification tells:
/// the files of the world and the parameters (failed), the times and sizes of the command line (usage). Asked
/// before anything is built, in the words of the controller. A specification that cannot be read passes;
/// whoever reads it says why.
///
/// with_world: the run is in the simulated world.
[[nodiscard]] int check_run(const project::LaunchOptions& options, bool with_world);

}  // namespace tessera::cli
