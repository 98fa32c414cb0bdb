#include "world_devices.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>

#include "world_library.hpp"

namespace tessera::testing {

std::unique_ptr<World> open(const WorldOptions& options) {
  std::string error;
  auto world = open_world(options, error);
  if (!world) throw std::runtime_error(error);
  return world;
}

double read(RealReceptor& receptor) {
  std::array<std::byte, 8> bytes{};
  EXPECT_TRUE(receptor.read(bytes));
  double value = 0;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

bool write(RealEffector& effector, double value) {
  return effector.write(std::as_bytes(std::span(&value, 1)));
}

std::string temporary(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("tessera_world_" + std::to_string(getpid()) + "_" + name);
}

std::string file_with(const std::string& name, const std::string& text) {
  std::ofstream(temporary(name)) << text;
  return temporary(name);
}

}  // namespace tessera::testing
