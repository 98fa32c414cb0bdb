#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tessera::project {

/// The file in which a user adds libraries and flags to the build of a project. It stands beside the
/// specification, and need not be there.
inline constexpr const char* user_build_file = "project.cmake";

/// Explains why CMake refused the project's own file: each of its errors once, at the line of project.cmake
/// that caused it, with the line and a hint (E511). Errors that come from elsewhere follow unchanged. Empty:
/// nothing is wrong with that file.
///
/// text: all output of CMake.
[[nodiscard]] std::string explain_cmake_errors(const std::string& text, const std::filesystem::path& project);

/// Explains which libraries and options of project.cmake the compiler or the linker refused: each once, at the
/// line that has it (E511). A word that stands nowhere in the file is told without a line. Empty: nothing was
/// refused, or the project has no such file.
///
/// output: of g++ or clang, and of GNU ld, gold, lld or mold.
[[nodiscard]] std::string explain_refused_words(std::string_view output,
                                                const std::filesystem::path& project);

}  // namespace tessera::project
