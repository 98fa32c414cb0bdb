#pragma once

#include <filesystem>
#include <vector>

namespace tessera {

/// A function of the library for ROS 2, which stays loaded. The library is that of TESSERA_ROS2_LIBRARY, or
/// else the one beside the program or in the first of the folders that has it. Throws DriverError.
[[nodiscard]] void* ros2_function(const std::vector<std::filesystem::path>& folders, const char* name);

}  // namespace tessera
