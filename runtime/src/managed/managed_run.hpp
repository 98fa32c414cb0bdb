#pragma once

#include <string>

#include "tessera/controller.hpp"

namespace tessera {

/// Makes this process a managed node of ROS 2, named after the system. Each `configure` starts the same program again
/// as a process of its own (RunOptions::orders), which has the devices, and `cleanup` ends it. So an unconfigured node
/// has no device, no claim and no guardian, and each run begins with the net's first marking.
///
/// argv: as `main` got it; the options of the runs. Returns the exit code: 0 after a shutdown, 1 if a run has failed or
/// the node cannot be made, 128 and a signal.
[[nodiscard]] int run_managed(const System& system, const RunOptions& options, int argc, char** argv);

/// The file of the recording of the run with that number, from 1: "run.tsr", "run-2.tsr". Empty stays empty.
[[nodiscard]] std::string recording_of_run(const std::string& recording, unsigned run);

}  // namespace tessera
