#pragma once

#include "project/launch.hpp"

namespace tessera::cli {

/// Returns `ok`, or the exit code of a run that cannot begin as requested, as far as the specification shows
/// it: `failed` for the files of the world and the parameters, `usage` for the times and sizes of the command
/// line. Called before anything is built; its messages are those of the controller. A specification that
/// cannot be read passes here, because another function reports that.
///
/// with_world: the run uses the simulated world.
[[nodiscard]] int check_run(const project::LaunchOptions& options, bool with_world);

}  // namespace tessera::cli
