#pragma once

#include <string>
#include <vector>

#include "cli/watching/running_controller.hpp"

/// The offers of running controllers to an operator: `tessera set` and `tessera panel` without values.
namespace tessera::cli {

/// Prints the parameters with their values, units and ranges. Returns the exit code: `failed` if a process does not
/// answer.
int list_parameters(std::vector<SeenController>& processes);
/// The same for panels. path: of one; empty: all.
int list_panels(std::vector<SeenController>& processes, const std::string& path);

}  // namespace tessera::cli
