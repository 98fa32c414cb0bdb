#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "project/build/controller.hpp"
#include "tessera/result.hpp"

/// A package of ROS 2 that builds a controller, for colcon and ament_cmake.
namespace tessera::project {

struct Ros2PackageOptions {
  std::string name;     ///< of the package; empty: that of the system
  std::string version;  ///< "1.2.3"; missing numbers are 0
  /// Gets a folder of the package's name with a copy of the project; empty: the files are written into the project.
  std::filesystem::path folder;
};

/// A text file of the package.
struct PackageFile {
  std::filesystem::path path;  ///< in the package
  std::string text;
};

/// The name that REP 144 permits nearest to `name`: "My Robot" becomes "my_robot".
[[nodiscard]] std::string ros2_package_name(std::string_view name);

/// package.xml, CMakeLists.txt, the launch file and the default values of all parameters.
///
/// Errors:  no driver of ROS 2, several processes, a name or version that ROS 2 does not permit.
/// Threads: pure, except that it looks for `project.cmake`.
[[nodiscard]] Result<std::vector<PackageFile>> ros2_package_files(const Specification& specification,
                                                                  const Ros2PackageOptions& options);

/// Writes the package, and returns its folder. Files that exist already are never replaced, unless they are the same.
///
/// Errors:  as ros2_package_files; a file exists with another text (nothing is written then). Throws
///          std::runtime_error if a file cannot be written.
[[nodiscard]] Result<std::filesystem::path> make_ros2_package(const Specification& specification,
                                                              const Ros2PackageOptions& options);

}  // namespace tessera::project
