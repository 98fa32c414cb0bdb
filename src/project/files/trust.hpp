#pragma once

#include <filesystem>

/// Whether the user trusts the code of a project: to build and to run it executes what its authors wrote. A
/// command line that builds or runs a project is consent. A page on which one click does so asks first.
///
/// The note about it is kept for the user (user_folder), by the path of the project, and not in the project,
/// which may come from others.
namespace tessera::project {

/// project: absolute.
[[nodiscard]] bool is_trusted(const std::filesystem::path& project);
/// false: the note cannot be kept.
bool trust(const std::filesystem::path& project);

}  // namespace tessera::project
