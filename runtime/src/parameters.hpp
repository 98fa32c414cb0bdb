#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tessera/subsystem.hpp"

namespace tessera {

/// The parameters of one subsystem, where they live.
struct ParameterOwner {
  std::string path;  ///< "robot[3].control"
  std::span<const Bindings::Parameter> parameters;
};

/// Gives parameters new values, in order. PATH is a name (every subsystem that has it), or a subsystem's path
/// and a name;
/// `[*]` in the path stands for any index.
///
/// Errors: a path that names nothing (with the nearest that does), a value of another kind or out of range.
/// Reports all,
///         one per line, then false; owners that come before keep what they got.
[[nodiscard]] bool set_parameters(std::span<const ParameterOwner> owners,
                                  std::span<const std::pair<std::string, std::string>> values,
                                  std::string& error);

/// Reads "path = value" lines; '#' starts a comment. Appends to `values`. false and `error` naming file and
/// line.
[[nodiscard]] bool read_parameter_file(const std::string& file,
                                       std::vector<std::pair<std::string, std::string>>& values,
                                       std::string& error);

}  // namespace tessera
