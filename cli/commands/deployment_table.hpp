#pragma once

#include <cstddef>
#include <string>

#include "project/process/deployment_watch.hpp"

namespace tessera::cli {

/// A screen for the table.
struct ScreenSize {
  std::size_t rows = SIZE_MAX, columns = SIZE_MAX;
};

/// All processes of a deployed system on one screen: who waits for whom, what each process does, and what
/// passes between them. What is in order is left out first if there is no room for all.
[[nodiscard]] std::string deployment_table(const std::string& system,
                                           const project::DeploymentWatch& deployment, ScreenSize screen);

}  // namespace tessera::cli
