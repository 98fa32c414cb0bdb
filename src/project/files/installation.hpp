#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tessera::project {

/// Where this installation keeps its parts. The command is relocatable: everything is found from its own
/// path, in an installed prefix (bin/tessera) as in a build tree (tessera beside share/ and lib/).
struct Installation {
  std::filesystem::path share;          ///< worlds/, tracks/, examples/, spec.schema.json
  std::filesystem::path cmake_package;  ///< folder of tesseraConfig.cmake
  std::filesystem::path world_library;  ///< libtessera_world.so

  /// Throws std::runtime_error that says what is missing.
  [[nodiscard]] static Installation find();
};

/// `name` as given if absolute; else in the project's folder; else in share/FOLDER. nullopt when it is
/// nowhere.
[[nodiscard]] std::optional<std::filesystem::path> find_asset(const std::string& name,
                                                              const std::filesystem::path& project,
                                                              const std::string& folder);

}  // namespace tessera::project
