#pragma once

#include <filesystem>

namespace tessera::project {

/// The folder where Tessera keeps the files of a project: generated, build, programs, runs, verdicts, last.
/// It is the first of these that applies:
///
///     TESSERA_STATE_DIR/NAME-HASH         if that variable is set
///     PROJECT/.tessera                    if it can be written to, or made
///     $STATE_DIRECTORY/NAME-HASH          if that variable is set (by systemd, with StateDirectory=)
///     $XDG_STATE_HOME/tessera/NAME-HASH   (XDG_STATE_HOME is ~/.local/state if it is not set)
///
/// NAME is the name of the project's folder; HASH is computed from its path.
///
/// project: absolute. The folder need not exist.
/// Throws std::runtime_error if there is no such folder.
[[nodiscard]] std::filesystem::path state_folder(const std::filesystem::path& project);

/// PROJECT/.tessera. Files that an earlier build left there count even if the folder is read-only.
[[nodiscard]] std::filesystem::path own_folder(const std::filesystem::path& project);

}  // namespace tessera::project
