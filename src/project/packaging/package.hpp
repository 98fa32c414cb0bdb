#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "project/build/controller.hpp"
#include "project/process/listener.hpp"
#include "tessera/result.hpp"

/// A file with all that a robot needs to run its processes: a package of Debian, or an archive.
namespace tessera::project {

struct PackageOptions {
  enum class Format : std::uint8_t { archive, debian } format = Format::archive;
  std::filesystem::path folder = ".";  ///< where the packages are written
  std::string host;                    ///< only that of this machine of the deployment; empty: all
  std::string version = "1.0";
  std::vector<std::string> groups;      ///< of the user who runs the units (ServiceOptions)
  std::vector<std::string> parameters;  ///< PATH=VALUE, as parameter_values gives them
  std::string architecture;             ///< "arm64"; empty: that of this machine
  std::filesystem::path libraries;      ///< folder of libtessera_dds.so and libtessera_ros2.so
};

struct Package {
  std::filesystem::path file;
  std::string host;                    ///< empty: none is given
  std::vector<std::string> processes;  ///< names; empty: the system is not deployed in processes
  std::vector<std::string> needs;      ///< packages of Debian: "libfmt9 (>= 9.1.0)"
};

/// The mistake in a version or a host, found before anything is built.
[[nodiscard]] std::optional<Problem> wrong_with(const PackageOptions& options, const spec::Model& model);

/// Writes a package per host of the deployment, or one. It has the controller, the libraries of Tessera that
/// the
/// controller loads, those that no package of Debian has, parameters, and the units of systemd. The units
/// are neither
/// enabled nor started when the package is installed: a robot moves when a person says so.
///
/// The same controller gives the same bytes; files have the time SOURCE_DATE_EPOCH of the environment, or
/// the year
/// 2000.
///
/// Errors:  throws std::runtime_error if a library is missing, a tool fails, or a file cannot be written.
/// Threads: one at a time for a folder.
[[nodiscard]] std::vector<Package> make_packages(const Controller& controller, const PackageOptions& options,
                                                 Listener& listener);

}  // namespace tessera::project
