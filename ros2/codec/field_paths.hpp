#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ros2/codec/value_type.hpp"

/// Paths of fields in messages and in the buffer: "linear.x", "poses[2].x"; an empty path is all of it.
namespace tessera::ros2 {

/// {"linear", "x"}
[[nodiscard]] std::vector<std::string> split_path(std::string_view path);
/// The path of a member of the structure at `path`, or of something inside that member; `path` itself if the name
/// is empty.
[[nodiscard]] std::string member_path(const std::string& path, const std::string& name);
/// The path of an element of the array at `path`; `path` itself if the type is no array.
[[nodiscard]] std::string element_path(const std::string& path, const ValueType& type, std::uint32_t index);
/// "poses[2].x" without the numbers of elements: "poses.x".
[[nodiscard]] std::string without_numbers(std::string path);

/// The text as error messages show a name: "'x'".
[[nodiscard]] std::string in_quotes(std::string_view text);
/// A part of the buffer as error messages name it: "the buffer's 'v'", "the buffer".
[[nodiscard]] std::string shown(const std::string& value_path);

}  // namespace tessera::ros2
