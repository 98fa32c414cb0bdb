#pragma once

#include <filesystem>

namespace tessera::project {

/// Throws std::runtime_error that names the character, when a path has one that CMake cannot handle in any
/// way of quoting: ; " \ [ ] | ` and control characters, and $ before { or <.
void check_path_for_cmake(const std::filesystem::path& path);

}  // namespace tessera::project
