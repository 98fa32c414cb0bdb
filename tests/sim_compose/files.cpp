#include "files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace tessera::testing {

namespace fs = std::filesystem;

std::string model(const std::string& name) { return TESSERA_SOURCE_DIR "/tests/sim_compose/models/" + name; }

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string file_with(const std::string& name, std::string_view content) {
  struct Folder {
    fs::path path = fs::temp_directory_path() / ("tessera_compose_" + std::to_string(::getpid()));
    ~Folder() {
      std::error_code none;
      fs::remove_all(path, none);
    }
  };
  static const Folder folder;
  const fs::path file = folder.path / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << content;
  return file.string();
}

sim::Placement placed(const std::string& name, const std::string& file, double x_m, double y_m) {
  return {name, file, x_m, y_m, 0, 0, std::nullopt};
}

sim::ComposedWorld loaded(const std::vector<sim::Placement>& placements, const std::string& world) {
  const auto composition = sim::compose(world, placements);
  if (!composition) throw std::runtime_error(composition.problem());
  auto composed = sim::load(*composition);
  if (!composed) throw std::runtime_error(composed.problem());
  return std::move(*composed);
}

std::string problem_of(const std::vector<sim::Placement>& placements, const std::string& world) {
  const auto composition = sim::compose(world, placements);
  if (!composition) return composition.problem();
  const auto composed = sim::load(*composition);
  if (composed) throw std::runtime_error("the placements have no problem");
  return composed.problem();
}

}  // namespace tessera::testing
