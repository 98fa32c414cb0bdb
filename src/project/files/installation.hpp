#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tessera::project {

/// The paths of the parts of this installation. The command is relocatable: it finds everything from its own
/// path, in an installed prefix (bin/tessera) and in a build tree (tessera beside share/ and lib/).
struct Installation {
  std::filesystem::path share;             ///< worlds/, tracks/, examples/, spec.schema.json
  std::filesystem::path cmake_package;     ///< folder of tesseraConfig.cmake
  std::filesystem::path world_library;     ///< libtessera_world.so, of MuJoCo
  std::filesystem::path coppelia_library;  ///< libtessera_coppelia.so
  std::filesystem::path carrier_library;   ///< libtessera_dds.so

  /// Throws std::runtime_error that names the missing part.
  [[nodiscard]] static Installation find();
};

/// `name` itself if it is absolute; otherwise in the project's folder; otherwise in share/FOLDER.
/// nullopt: the file does not exist.
[[nodiscard]] std::optional<std::filesystem::path> find_asset(const std::string& name,
                                                              const std::filesystem::path& project,
                                                              const std::string& folder);

}  // namespace tessera::project
