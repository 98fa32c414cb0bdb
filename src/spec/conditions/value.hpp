#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "spec/model/model.hpp"
#include "spec/values/types.hpp"

namespace tessera::spec {

/// The facts about the value of a part of a condition before it is compiled.
struct Value {
  enum class Kind : std::uint8_t {
    unknown,  ///< left to the compiler
    boolean,
    number,
    duration,
    time,
    text,
    array,
    structure,
    choice  ///< a memory cell with values, or one of its values (`literal`)
  } kind = Kind::unknown;
  bool declared = false;    ///< `type` means something
  bool literal = false;     ///< a number or a duration as it is written
  bool comparison = false;  ///< a comparison without brackets around it
  Type type{};
  std::size_t begin = 0, end = 0;  ///< in the text, in bytes
  const Field* few = nullptr;      ///< the memory cell with few values that it is, or whose value it is
  std::string time_unit{};         ///< of a number that measures a time: "s"; empty: it measures none

  [[nodiscard]] bool is_compound() const {
    return kind == Kind::array || kind == Kind::structure || kind == Kind::text || kind == Kind::choice;
  }
  [[nodiscard]] bool is_plain() const { return kind == Kind::boolean || kind == Kind::number; }
};

/// A value in words, for a message: "a duration", "a number (float64 m)".
[[nodiscard]] std::string in_words(const Value& value, const Types& types);

}  // namespace tessera::spec
