#pragma once

#include <filesystem>
#include <string>

namespace tessera::project {

/// Keeps a program that was just built under a unique name in STATE/programs, where no other build replaces
/// it, and returns that path. The same program gets the same name. Programs that no run refers to any more
/// are removed after an hour, except the newest of each kind.
///
/// Errors:  throws std::runtime_error if it cannot be copied.
/// Threads: one at a time for a state folder, over all processes (take_build_lock).
[[nodiscard]] std::filesystem::path keep_program(const std::filesystem::path& state,
                                                 const std::filesystem::path& built, const std::string& kind);

}  // namespace tessera::project
