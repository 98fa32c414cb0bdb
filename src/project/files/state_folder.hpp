#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace tessera::project {

/// The folder where Tessera keeps the files of a project: generated, build, programs, runs, last.
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

/// The folder of what Tessera keeps for the user and not for a project: verdicts, and which projects are
/// trusted. A project that came from others has no part in it. It is the first of these:
///
///     TESSERA_STATE_DIR        if that variable is set
///     $STATE_DIRECTORY         if that variable is set
///     $XDG_STATE_HOME/tessera  (XDG_STATE_HOME is ~/.local/state if it is not set)
///
/// nullopt: there is no such folder, since HOME is not set either.
[[nodiscard]] std::optional<std::filesystem::path> user_folder();

/// Whether this user has written the file, and no other can change it: only then it counts.
[[nodiscard]] bool is_kept_by_user(const std::filesystem::path& file);
/// Writes a file below user_folder(), which only this user can read. Throws std::runtime_error.
void keep_for_user(const std::filesystem::path& file, std::string_view text);

/// PROJECT/.tessera. Files that an earlier build left there count even if the folder is read-only.
[[nodiscard]] std::filesystem::path own_folder(const std::filesystem::path& project);

}  // namespace tessera::project
