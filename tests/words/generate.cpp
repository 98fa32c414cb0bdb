// Writes the controller of spec.yaml: generate SPEC FOLDER
#include <filesystem>
#include <fstream>

#include "codegen/generated.hpp"

int main(int, char** arguments) {
  const std::filesystem::path folder = arguments[2];
  for (const auto& file : tessera::test::generate(tessera::test::read_file(arguments[1])).files) {
    std::filesystem::create_directories((folder / file.path).parent_path());
    std::ofstream(folder / file.path, std::ios::binary) << file.text;
  }
}
