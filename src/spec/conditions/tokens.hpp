#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::spec {

/// A part of a condition, which is one expression of C++ in which a number may have a unit after a blank.
struct Token {
  enum class Kind : std::uint8_t {
    name,      ///< an identifier or a keyword
    number,    ///< "3", "0.5f", "1s"
    duration,  ///< "1s", "500 ms"
    quantity,  ///< a number with another unit after a blank: "5 cm"
    text,      ///< a literal in quotes
    mark,      ///< an operator or a bracket
    end
  } kind = Kind::end;
  std::string_view text;
  std::size_t position = 0;  ///< in bytes

  [[nodiscard]] bool is(std::string_view what) const {
    return (kind == Kind::mark || kind == Kind::name) && text == what;
  }
  [[nodiscard]] bool is_one_of(std::initializer_list<std::string_view> marks) const {
    return std::any_of(marks.begin(), marks.end(), [this](std::string_view mark) { return is(mark); });
  }
};

/// Whether std::chrono has literals for the unit: h, min, s, ms, us and ns.
[[nodiscard]] bool is_duration_unit(std::string_view unit);

/// The tokens of an expression whose brackets and quotes match; the last one is `end`.
[[nodiscard]] std::vector<Token> tokens_of(std::string_view expression);

/// The expression as C++ has it: "500 ms" becomes "500ms ", so that columns stay.
[[nodiscard]] std::string with_cpp_durations(std::string expression);

}  // namespace tessera::spec
