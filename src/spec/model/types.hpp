#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/few_values.hpp"
#include "spec/model/ids.hpp"
#include "spec/model/member.hpp"
#include "tessera/scalar.hpp"

namespace tessera::spec {

using diagnostics::Span;

/// The type of a buffer, field or parameter.
struct Type {
  enum class Kind : std::uint8_t { scalar, string, structure } kind = Kind::scalar;
  Scalar scalar = Scalar::float64;
  std::uint32_t capacity = 256;  ///< of a string, in bytes
  StructureId structure;         ///< of a structure
  std::uint64_t extent = 0;      ///< elements of an array; 0: not an array
  bool is_sequence = false;      ///< an array of 0 to `extent` elements, as its value has
  std::string unit;              ///< "m/s"; empty: none given

  bool operator==(const Type&) const = default;

  /// The type of an element of an array.
  [[nodiscard]] Type element() const {
    Type one = *this;
    one.extent = 0;
    one.is_sequence = false;
    return one;
  }
};

/// A named and typed piece of data: field of a structure, buffer, memory cell.
struct Field {
  std::string name;
  Type type;
  std::string initial;  ///< C++ initialiser without braces; empty: zero. Only memory cells have one.
  Span span;
  std::optional<FewValues> few{};  ///< of a memory cell that is part of the net; `type` then means nothing
  std::optional<Member> member{};  ///< of a buffer of which there is one for each member of a fleet
};

struct Structure {
  std::string name;
  std::vector<Field> fields;
  Span span;
};

/// A constant that can be changed without recompiling: a scalar, a string, or an array of scalars.
struct Parameter {
  std::string name;
  Type type;
  std::string initial;  ///< C++ initialiser
  std::optional<double> minimum, maximum;
  Span span;
};

}  // namespace tessera::spec
