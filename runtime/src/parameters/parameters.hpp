#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tessera/given_values.hpp"
#include "tessera/result.hpp"
#include "tessera/subsystem.hpp"

namespace tessera {

/// A value that fits a parameter but has not been assigned yet.
struct CheckedValue {
  std::uint32_t owner = 0;  ///< into the owners
  Bindings::Parameter parameter;
  std::vector<std::byte> bytes;  ///< as the parameter is stored in memory

  void give() const { std::memcpy(parameter.value, bytes.data(), bytes.size()); }
};

/// Returns why that value does not fit the parameters that `path` names (see set_parameters). nullopt: it
/// fits, and `checked` has one more entry for each of them.
[[nodiscard]] std::optional<Problem> check_parameter(std::span<const ParameterOwner> owners,
                                                     const std::string& path, const std::string& value,
                                                     std::vector<CheckedValue>& checked);

/// A value as `--set` takes it, without its unit: "0.2", "[1, 2]". at: as the parameter is stored in memory.
[[nodiscard]] std::string text_of(const Bindings::Parameter& parameter, const void* at);

/// Whether `path` names a parameter of one of the owners (see set_parameters).
[[nodiscard]] bool has_parameter(std::span<const ParameterOwner> owners, const std::string& path);

/// Reads "path = value" lines; '#' starts a comment. Appends to `values`. false and
/// `error` with file and line.
[[nodiscard]] bool read_parameter_file(const std::string& file,
                                       std::vector<std::pair<std::string, std::string>>& values,
                                       std::string& error);

}  // namespace tessera
