#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace tessera {

/// The content of a file; "" if it cannot be read. In blocks: byte by byte, a recording takes seconds in a test
/// that is not optimised.
[[nodiscard]] inline std::string file_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

}  // namespace tessera
