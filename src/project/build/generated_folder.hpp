#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "codegen/codegen.hpp"

namespace tessera::project {

/// Per generated source, by its path: the lines whose text stands in the specification.
using GeneratedLines = std::map<std::filesystem::path, std::vector<codegen::SourceLine>>;

/// The owner of the files of a folder that the list does not name.
enum class Unlisted : std::uint8_t {
  foreign,     ///< files that Tessera has not written, always
  by_heading,  ///< ours if they begin like generated files: for folders of versions that kept no list
};

/// The changes to the files of a folder.
struct GeneratedFiles {
  std::size_t written = 0;                       ///< files that were missing or differed
  std::vector<std::filesystem::path> set_aside;  ///< new paths of files that were edited
};

/// Makes a folder hold these files. It keeps a list of them there (`.tessera-files`, with hashes) and
/// touches no file that the list does not name. Files of the last time that are no longer needed are
/// removed only if they are unchanged; a file that was edited since is renamed to NAME.edited.
///
/// Errors:  throws std::runtime_error, before anything is changed, if a file that is not ours, a symbolic
///          link or a folder is in the way; also if a file cannot be written.
/// Threads: one at a time for a folder, over all processes (BuildLock).
[[nodiscard]] GeneratedFiles write_generated(const std::filesystem::path& folder,
                                             const std::vector<codegen::File>& files, Unlisted unlisted);

}  // namespace tessera::project
