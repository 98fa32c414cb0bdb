#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "checks/expression.hpp"
#include "tessera/nearest.hpp"

namespace tessera::checks {

/// The mistake in a text, and its position.
struct Mistake {
  Place place;
  std::string text;
  Hint hint;
};

/// The parsed text, or the first mistake.
template <class T>
struct Parsed {
  std::optional<T> value;
  Mistake mistake;  ///< if there is no value
};

/// The value of a unit in SI units; nullopt: there is no such unit.
struct Unit {
  double factor = 1;
  std::string in_si;  ///< "m/s" for "cm/min"
};
using Units = std::function<std::optional<Unit>(std::string_view unit)>;

/// Reads the grammar at the head of expression.hpp, from any text. It is a mistake, too, to compare, add or
/// subtract numbers of different units.
[[nodiscard]] Parsed<Formula> parse_formula(std::string_view text, const Units& units);
[[nodiscard]] Parsed<Number> parse_number(std::string_view text, const Units& units);

/// For texts that text_of has made: no unit is known, and none is compared.
inline const Units no_units;

}  // namespace tessera::checks
