#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "codegen/codegen.hpp"

namespace tessera::project {

/// Whose the files of a folder are that no list of ours names.
enum class Unlisted : std::uint8_t {
  foreign,     ///< somebody else's, always
  by_heading,  ///< ours if they begin as generated files do: folders of versions that kept no list
};

/// What became of the files of a folder.
struct GeneratedFiles {
  std::size_t written = 0;                       ///< those that were not there, or differed
  std::vector<std::filesystem::path> set_aside;  ///< where files are now that somebody had edited
};

/// Makes a folder hold these files. It keeps a list of them there (`.tessera-files`, with hashes), and
/// touches nothing that the list does not name: files of the last time that are no longer wanted are removed
/// only as they were written; one that has been edited since is renamed to NAME.edited.
///
/// Errors:  throws std::runtime_error, before anything is changed, when a file that is not ours is in the
///          way (or a symbolic link, or a folder); also when one cannot be written.
/// Threads: one at a time for a folder, over all processes (BuildLock).
[[nodiscard]] GeneratedFiles write_generated(const std::filesystem::path& folder,
                                             const std::vector<codegen::File>& files, Unlisted unlisted);

}  // namespace tessera::project
