#include "project/files/cmake_path_check.hpp"

#include <fmt/core.h>

#include <optional>
#include <stdexcept>
#include <string>

namespace tessera::project {

namespace {

/// "the character ';'"; nullopt: CMake can handle the path.
std::optional<std::string> trouble_in(std::string_view path) {
  for (std::size_t at = 0; at < path.size(); ++at) {
    const auto byte = static_cast<unsigned char>(path[at]);
    if (byte < 0x20 || byte == 0x7f) return fmt::format("a control character (code {})", byte);
    if (std::string_view(";\"\\[]|`").find(path[at]) != std::string_view::npos)
      return fmt::format("the character {}", path[at]);
    if (path[at] == '$' && path.find_first_of("{<(", at) != std::string_view::npos)
      return fmt::format("the character $ before {}", path[path.find_first_of("{<(", at)]);
  }
  return std::nullopt;
}

/// The path with control characters made visible.
std::string shown(std::string_view path) {
  std::string text;
  for (const char character : path) {
    const auto byte = static_cast<unsigned char>(character);
    text += byte < 0x20 || byte == 0x7f ? fmt::format("\\x{:02x}", byte) : std::string(1, character);
  }
  return text;
}

}  // namespace

void check_path_for_cmake(const std::filesystem::path& path) {
  const std::optional<std::string> trouble = trouble_in(path.native());
  if (trouble)
    throw std::runtime_error(fmt::format("the path {} has {}, which CMake cannot handle: rename that folder",
                                         shown(path.native()), *trouble));
}

}  // namespace tessera::project
