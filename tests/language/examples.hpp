#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "language/language.hpp"

namespace tessera::language {

inline std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

inline const Grammar& grammar() {
  static const Grammar the(read_text(TESSERA_SOURCE_DIR "/share/tessera/spec.schema.json"));
  return the;
}

inline std::filesystem::path example(const std::string& name) {
  return std::filesystem::path(TESSERA_SOURCE_DIR) / "examples" / name;
}

/// The folders of all examples.
inline std::vector<std::filesystem::path> examples() {
  std::vector<std::filesystem::path> all;
  for (const auto& folder : std::filesystem::directory_iterator(TESSERA_SOURCE_DIR "/examples"))
    if (std::filesystem::exists(folder.path() / "spec.yaml")) all.push_back(folder.path());
  std::sort(all.begin(), all.end());
  return all;
}

/// The C++ of an example.
inline std::vector<Source> sources_of(const std::filesystem::path& folder) {
  std::vector<Source> all;
  for (const char* part : {"src", "test"})
    if (std::filesystem::exists(folder / part))
      for (const auto& file : std::filesystem::recursive_directory_iterator(folder / part))
        if (file.path().extension() == ".cpp" || file.path().extension() == ".hpp")
          all.push_back({std::filesystem::relative(file.path(), folder).string(), read_text(file.path())});
  return all;
}

/// A text with a cursor, which is written as ‸.
struct Typed {
  explicit Typed(const std::string& with_cursor) {
    const std::string mark = "‸";
    const std::size_t at = with_cursor.find(mark);
    text = with_cursor.substr(0, at) + with_cursor.substr(at + mark.size());
    cursor = Lines(text).position(at);
  }
  std::string text;
  Position cursor;
};

}  // namespace tessera::language
