#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tessera/result.hpp"

namespace tessera::server {

/// [{"name", "title"}]: the examples in a folder, in the order of their names. The title is the first comment
/// of the specification.
[[nodiscard]] nlohmann::json examples_in(const std::filesystem::path& folder);

struct Begun {
  std::vector<std::string> files;  ///< that were copied
  std::vector<std::string> kept;   ///< existing files of the same name, which were kept
  std::optional<Problem> problem;  ///< nullopt: it was copied
};

/// Copies an example into a project that has no specification, or an empty one. Replaces no file.
///
/// Errors: there is no such example, the project has a specification, a file cannot be written.
[[nodiscard]] Begun begin_with(const std::filesystem::path& examples, const std::string& name,
                               const std::filesystem::path& specification);

}  // namespace tessera::server
