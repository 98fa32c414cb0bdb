#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/result.hpp"

/// Files of parameters of ROS 2. They are YAML, but a controller should need no library of YAML on the robot. So this
/// reads maps, lists and single values, in blocks or in brackets, and refuses the rest: anchors, tags, texts of several
/// lines, several documents.
namespace tessera::ros2 {

struct YamlNode {
  enum class Kind : std::uint8_t { scalar, list, map } kind = Kind::scalar;
  std::string text;     ///< of a scalar
  bool quoted = false;  ///< of a scalar: it is a text, also if it looks like a number
  std::vector<YamlNode> items;
  std::vector<struct YamlEntry> entries;  ///< no key comes twice
  std::size_t line = 1;
};
struct YamlEntry {
  std::string key;
  YamlNode node;
};

/// A file without values is an empty map. Errors: "LINE: reason".
[[nodiscard]] Result<YamlNode> read_yaml(std::string_view text);

}  // namespace tessera::ros2
