#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "language/text/lines.hpp"

/// Words of C++ code, of conditions and of formulas. No compiler: only what can be told from the words.
namespace tessera::language {

struct Token {
  enum class Kind : std::uint8_t { name, sign, literal } kind = Kind::sign;
  Extent extent;
  std::string_view text;  ///< of the source: "in", "->", "::", "."
};

/// The words of `source` without comments and lines of the preprocessor. Texts and numbers are literals.
[[nodiscard]] std::vector<Token> tokens_of(std::string_view source);

/// A name in a path: the "control" of "robot[3].control.line".
struct PathWord {
  std::string_view name;
  Extent extent;
};

/// A path in a channel, a formula or a key.
struct DottedPath {
  std::vector<PathWord> words;
  bool before_arrow = false;  ///< followed by ->
  bool after_arrow = false;
  Extent extent;
};

/// All paths of a text, in its order. Words such as `and` are paths of one word.
[[nodiscard]] std::vector<DottedPath> paths_in(std::string_view text);

/// The objects of a simulated world in a check, a measure or a target: `robot[3]`, `arm/hand`. Functions,
/// units and parts of paths are none. only_marked: those alone that an index or a part tells from other words.
[[nodiscard]] std::vector<Extent> objects_in(std::string_view text, bool only_marked);

}  // namespace tessera::language
