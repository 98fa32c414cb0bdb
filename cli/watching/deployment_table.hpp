#pragma once

#include <cstddef>
#include <string>

#include "project/process/deployment_watch.hpp"

namespace tessera::cli {

/// A screen for the table.
struct ScreenSize {
  std::size_t rows = SIZE_MAX, columns = SIZE_MAX;
};

/// All processes of a deployed system on one screen: which process waits for which, the state of each
/// process, and the messages between them. If the screen is too small, lines without a problem are left out
/// first.
[[nodiscard]] std::string deployment_table(const std::string& system,
                                           const project::DeploymentWatch& deployment, ScreenSize screen);

}  // namespace tessera::cli
