#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tessera::project {

/// The libraries and packages that programs need.
struct LibraryNeeds {
  /// Debian packages that have them: "libfmt9 (>= 9.1.0+ds1)"
  std::vector<std::string> packages;
  /// libraries that no Debian package of this machine has
  std::vector<std::filesystem::path> foreign;
};

/// Asks dpkg-shlibdeps, which knows the oldest version that will do.
///
/// files: programs and libraries. is_for_this_machine: they are made for its kind of processor; for another one,
///        the packages of the same names are meant, from the versions of this machine on.
///
/// Errors: throws std::runtime_error if a file cannot be read, a library cannot be found, or a tool is missing.
[[nodiscard]] LibraryNeeds libraries_of(const std::vector<std::filesystem::path>& files,
                                        bool is_for_this_machine);

/// "amd64"; what dpkg says. Throws std::runtime_error without dpkg.
[[nodiscard]] std::string architecture_of_this_machine();

}  // namespace tessera::project
