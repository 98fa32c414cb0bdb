#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ros2/definitions/type.hpp"

namespace tessera::ros2 {

/// The type of a real buffer, as tessera/value_encoding.hpp writes it: "{v: float64, omega: float64}".
struct ValueType {
  Primitive primitive = Primitive::boolean;
  std::uint32_t capacity = 0;  ///< of a string, in bytes
  std::uint32_t count = 0;     ///< elements of an array; 0: no array
  bool is_sequence = false;    ///< an array of 0 to `count` elements
  struct Member;
  std::vector<Member> members;

  /// "float64[8]", "a structure"
  [[nodiscard]] std::string text() const;
  /// nullptr: no member has that name.
  [[nodiscard]] const Member* find(std::string_view name) const;
};
struct ValueType::Member {
  std::string name;
  ValueType type;
};

/// nullopt: the text describes no type, or one of unknown fields.
[[nodiscard]] std::optional<ValueType> parse_value_type(std::string_view text);

}  // namespace tessera::ros2
