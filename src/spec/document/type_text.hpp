#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "spec/document/document.hpp"

namespace tessera::spec {

/// The parts of a type as written: NAME [<=CAPACITY] ['[' EXTENT ']' | <=EXTENT] [UNIT], where only a string has
/// a capacity.
struct TypeText {
  std::string name;
  Span name_span;
  std::optional<std::uint32_t> capacity;
  std::uint64_t extent = 0;  ///< 0: no array
  bool is_sequence = false;  ///< an array of 0 to `extent` elements
  std::string unit;
  Span unit_span;
};

/// Errors: E201 not of that form; E204 a capacity or extent of zero or out of range.
[[nodiscard]] std::optional<TypeText> split_type(const Node& text, Diagnostics& out);

/// Whether a text can be a unit. Units are used in comments and labels, so their characters are limited.
/// Brackets are those of an array.
[[nodiscard]] bool is_unit(std::string_view text);

}  // namespace tessera::spec
