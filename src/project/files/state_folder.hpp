#pragma once

#include <filesystem>

namespace tessera::project {

/// Where Tessera keeps what it makes of a project: generated, build, programs, runs, verdicts, last.
///
///     TESSERA_STATE_DIR      NAME-HASH in it, if it is set: NAME is the project's folder, HASH tells its
///     path PROJECT/.tessera       if it can be written to, or made $STATE_DIRECTORY       else NAME-HASH in
///     it (systemd sets it for a service with StateDirectory=) $XDG_STATE_HOME/tessera,
///     ~/.local/state/tessera     else NAME-HASH in it
///
/// project: absolute. The folder need not exist.
/// Throws std::runtime_error when there is no place.
[[nodiscard]] std::filesystem::path state_folder(const std::filesystem::path& project);

/// PROJECT/.tessera: what an earlier build left there counts even where nothing can be written.
[[nodiscard]] std::filesystem::path own_folder(const std::filesystem::path& project);

}  // namespace tessera::project
