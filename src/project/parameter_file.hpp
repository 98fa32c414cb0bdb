#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tessera::project {

/// A parameter that a run changes.
struct GivenParameter {
  std::string path;   ///< "v", "robot.control.v", "robot[1].control.v"
  std::string value;  ///< as written; of a list "[1, 2, 3]"
  std::string where;  ///< "params.yaml:3:4: ", or empty: of the command line
};

/// The values of a YAML file. Nested maps and dotted paths mean the same. The order of the lines does not
/// count: more specific paths come later, so that they win.
///
/// Throws std::runtime_error, with file and line, if the file is no map of values and lists of values, or
/// if it gives a value twice.
[[nodiscard]] std::vector<GivenParameter> read_parameter_file(const std::filesystem::path& file);

/// PATH=VALUE of a command line. Throws std::runtime_error if it has another form.
[[nodiscard]] GivenParameter read_assignment(const std::string& assignment);

}  // namespace tessera::project
