#include "ros2/codec/field_paths.hpp"

#include <algorithm>
#include <cstddef>

namespace tessera::ros2 {

std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> parts;
  while (!path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    parts.emplace_back(path.substr(0, dot));
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return parts;
}

std::string member_path(const std::string& path, const std::string& name) {
  return path.empty() ? name : name.empty() ? path : path + "." + name;
}

std::string element_path(const std::string& path, const ValueType& type, std::uint32_t index) {
  return type.count == 0 ? path : path + "[" + std::to_string(index) + "]";
}

std::string without_numbers(std::string path) {
  for (std::size_t open = 0; (open = path.find('[')) != std::string::npos;)
    path.erase(open, path.find(']') + 1 - open + (open == 0 ? 1 : 0));
  return path;
}

std::string in_quotes(std::string_view text) { return "'" + std::string(text) + "'"; }

std::string shown(const std::string& value_path) {
  return value_path.empty() ? "the buffer" : "the buffer's " + in_quotes(value_path);
}

}  // namespace tessera::ros2
