#pragma once

#include <filesystem>

namespace tessera::project {

/// Throws std::runtime_error that names the character if a path has one that CMake cannot handle, however
/// it is quoted: ; " \ [ ] | ` and control characters, and $ before { or <.
void check_path(const std::filesystem::path& path);

}  // namespace tessera::project
