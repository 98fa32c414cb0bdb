#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace tessera {

/// A function of the library for ROS 2, which stays loaded. The library is the one that TESSERA_ROS2_LIBRARY
/// names, otherwise the one beside the program or in the first folder that has it. Throws DriverError.
[[nodiscard]] void* ros2_function(const std::vector<std::filesystem::path>& folders, const char* name);

/// The folder of the library that drivers of this process were made with; nullopt: there were none.
/// Threads: any.
[[nodiscard]] std::optional<std::filesystem::path> ros2_folder_in_use();

}  // namespace tessera
