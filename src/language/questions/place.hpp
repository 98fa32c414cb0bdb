#pragma once

#include <optional>
#include <vector>

#include "language/schema/grammar.hpp"
#include "language/text/outline.hpp"

namespace tessera::language {

/// The key or scalar at a position.
struct PlaceInText {
  Way way;                       ///< of the value; at a key, of the map that has it
  const Entry* key = nullptr;    ///< set at a key
  const Node* scalar = nullptr;  ///< set at a scalar
  const Node* parent = nullptr;  ///< the map or list that holds it; nullptr at the top
};

/// nullopt: in a comment or between two things.
[[nodiscard]] std::optional<PlaceInText> place_at(const Outline& outline, std::size_t offset);

/// The node at `way`; a null node if there is none.
[[nodiscard]] const Node& node_at(const Outline& outline, const Way& way);

}  // namespace tessera::language
