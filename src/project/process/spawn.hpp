#pragma once

#include <spawn.h>
#include <sys/types.h>

#include "project/process/process.hpp"

namespace tessera::project {

/// Starts a program, which receives all signals whatever this process blocks. own_group: Ctrl-C does not
/// reach it. Throws std::runtime_error if it cannot be started.
[[nodiscard]] pid_t spawn(const Command& command, posix_spawn_file_actions_t* actions, bool own_group);

}  // namespace tessera::project
