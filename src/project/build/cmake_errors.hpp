#pragma once

#include <filesystem>
#include <string>

namespace tessera::project {

/// The file in which a user adds libraries and flags to the build of a project. It stands beside the
/// specification, and need not be there.
inline constexpr const char* user_build_file = "project.cmake";

/// Says where CMake refused the project's own file: each of its errors once, at the line of project.cmake
/// that caused it (E511), in CMake's words. Errors that come from elsewhere follow unchanged. Empty: nothing is
/// wrong with that file.
///
/// text: all output of CMake.
[[nodiscard]] std::string explain_cmake_errors(const std::string& text, const std::filesystem::path& project);

}  // namespace tessera::project
