#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "spec/document/document.hpp"
#include "spec/values/types.hpp"

/// Values of the file as C++.
namespace tessera::spec {

/// A number of a value that is infinite or NaN.
struct NonFiniteNumber {
  std::string
      path;  ///< of its field, without the numbers of elements: "pose.position"; empty: the value itself
  Span span;
};

/// The C++ initialiser (without its braces) of a value of `type`. Numbers may have the unit of the type. A
/// list gives an array, and a map gives a structure, whose missing fields are zero.
///
/// what:   the value in words, e.g. "the default".
/// non_finite: receives the numbers `.nan` and `.inf`; nullptr: they are no numbers.
/// Errors: E101 unknown field; E203 of another type; E204 out of the range of the type; E208 another unit.
[[nodiscard]] std::optional<std::string> initialiser(const Node& node, Span at, const Type& type,
                                                     const Types& types, std::string_view what,
                                                     Diagnostics& out,
                                                     std::vector<NonFiniteNumber>* non_finite = nullptr);

/// `value` as a double in C++: "2.0", "1e-07".
[[nodiscard]] std::string float_literal(double value);

/// `text` as a string literal of C++, quotes included.
[[nodiscard]] std::string string_literal(std::string_view text);

}  // namespace tessera::spec
