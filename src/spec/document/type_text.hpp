#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "spec/document/document.hpp"

namespace tessera::spec {

/// The parts of a type as written: NAME [<=CAPACITY] ['[' EXTENT ']'] [UNIT].
struct TypeText {
  std::string name;
  Span name_span;
  std::optional<std::uint32_t> capacity;
  std::uint64_t extent = 0;  ///< 0: no array
  std::string unit;
  Span unit_span;
};

/// Errors: E201 not of that form; E204 a capacity or extent of zero or out of range.
[[nodiscard]] std::optional<TypeText> split_type(const Node& text, Diagnostics& out);

}  // namespace tessera::spec
