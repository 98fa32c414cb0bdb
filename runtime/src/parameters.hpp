#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
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

/// A value that fits a parameter but has not been given to it.
struct CheckedValue {
  std::uint32_t owner = 0;  ///< into the owners
  Bindings::Parameter parameter;
  std::vector<std::byte> bytes;  ///< as the parameter lies in memory

  void give() const { std::memcpy(parameter.value, bytes.data(), bytes.size()); }
};

/// What is wrong with that value for the parameters that `path` names (see set_parameters); empty: nothing,
/// and `checked` has one more entry for each of them.
[[nodiscard]] std::string check_parameter(std::span<const ParameterOwner> owners, const std::string& path,
                                          const std::string& value, std::vector<CheckedValue>& checked);

/// Gives parameters new values, in order. PATH is a name (every subsystem that has it), or a subsystem's path
/// and a name;
/// `[*]` in the path stands for any index.
///
/// Errors: a path that names nothing (with the nearest that does), a value of another kind or out of range.
/// Reports all,
///         one per line, then false; assignments that are right take place all the same.
[[nodiscard]] bool set_parameters(std::span<const ParameterOwner> owners,
                                  std::span<const std::pair<std::string, std::string>> values,
                                  std::string& error);

/// Reads "path = value" lines; '#' starts a comment. Appends to `values`. false and `error` naming file and
/// line.
[[nodiscard]] bool read_parameter_file(const std::string& file,
                                       std::vector<std::pair<std::string, std::string>>& values,
                                       std::string& error);

}  // namespace tessera
