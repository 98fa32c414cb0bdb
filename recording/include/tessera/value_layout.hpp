#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tessera/value_text.hpp"

namespace tessera {

/// A type: a scalar, a text, a sequence of one type, or fields.
struct ValueLayout::Node {
  enum class Kind : std::uint8_t { boolean, integer, natural, real, text, bytes, sequence, structure };
  struct Field {
    std::string name;
    std::shared_ptr<const Node> type;
  };
  Kind kind = Kind::bytes;
  std::size_t size = 0;                 ///< bytes of a scalar; capacity of a text; count of a sequence
  std::shared_ptr<const Node> element;  ///< of a sequence
  std::vector<Field> fields;            ///< of a structure
  std::size_t scalars = 1;              ///< in total
  bool bounded = false;                 ///< a sequence of at most `size` elements
};

}  // namespace tessera
