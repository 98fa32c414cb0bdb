#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "tessera/control_messages.hpp"

namespace tessera::cli {

/// A deployed system that `tessera top` shows as a whole.
struct WatchedSystem {
  std::string name;
  std::size_t found = 0;                      ///< so many of its processes run on this machine
  std::optional<Snapshot::Deployment> given;  ///< where they meet, by the specification; or a process says it
  bool firm = false;                          ///< `given` is what the user wants, whatever processes say
};
struct WatchOptions {
  bool once = false, lines = false;
};
/// Shows its processes on all machines until all have ended. Returns the exit code.
[[nodiscard]] int watch_deployment(const WatchedSystem& system, const WatchOptions& options);

}  // namespace tessera::cli
