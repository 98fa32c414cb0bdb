#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The files of a user's project that name parts of its specification, and how several of them change at once.
namespace tessera::project {

/// Whether it is C++ by its name.
[[nodiscard]] bool is_code(const std::filesystem::path& file);

/// The C++ in src/ and test/, and params.yaml: at most 1000 files of at most 1 MB, sorted. No symbolic link is
/// followed, and no folder whose name begins with a dot.
[[nodiscard]] std::vector<std::filesystem::path> user_sources(const std::filesystem::path& project);

/// The same, and the layout of the drawing. The page of the studio changes that file by itself (server/analysis/layout_file.hpp).
[[nodiscard]] std::vector<std::filesystem::path> files_with_names(const std::filesystem::path& project);

struct Replacement {
  std::filesystem::path file;
  std::string before;  ///< what the change was made of; empty also for a file that is not there
  std::string after;
};

/// Replaces all of the files or none: nothing is written if one of them is a symbolic link, has another text by now, or
/// has no room on the disk. Files with `after` like `before` are only compared: whoever names all that it has read
/// gets no mixture with a change that another process makes at the same time. Such changes of one project wait for
/// each other (a lock on its folder).
///
/// Returns: why none was replaced, with the name of the file; nullopt: all were.
/// Threads: any.
[[nodiscard]] std::optional<std::string> replace_together(const std::filesystem::path& project,
                                                          const std::vector<Replacement>& files);

}  // namespace tessera::project
