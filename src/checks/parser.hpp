#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "checks/expression.hpp"

namespace tessera::checks {

/// What is wrong with a text, and where.
struct Mistake {
  Place place;
  std::string text, hint;
};

/// What was read, or the first mistake.
template <class T>
struct Parsed {
  std::optional<T> value;
  Mistake mistake;  ///< if there is no value
};

/// The factor of a unit to SI units; nullopt: there is no such unit.
using Units = std::function<std::optional<double>(std::string_view unit)>;

/// Reads what the head of expression.hpp describes. Never fails otherwise, whatever the text.
[[nodiscard]] Parsed<Formula> parse_formula(std::string_view text, const Units& units);
[[nodiscard]] Parsed<Number> parse_number(std::string_view text, const Units& units);

/// For texts that text_of has made.
[[nodiscard]] inline std::optional<double> no_units(std::string_view /*unit*/) { return std::nullopt; }

}  // namespace tessera::checks
