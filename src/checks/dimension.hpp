#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tessera::checks {

/// The dimension of a number, as powers of m, rad and s. A number of unknown unit, such as that of a sensor,
/// can be compared with every number.
struct Dimension {
  enum class Known : std::uint8_t {
    bare,    ///< a number without a unit: it takes that of its surroundings
    never,   ///< only the user knows it
    by_unit  ///< as the powers say
  } known = Known::bare;
  int length = 0, angle = 0, time = 0;
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// unit: of SI, such as "m", "rad", "Hz" or "m/s".
[[nodiscard]] Dimension dimension_of_unit(std::string_view unit);
/// "m/s"; empty: a plain number, or one whose unit is not known.
[[nodiscard]] std::string unit_of(const Dimension& dimension);
/// The same for a message; a plain number: "a plain number".
[[nodiscard]] std::string name_of(const Dimension& dimension);

/// Whether both may be compared and added.
[[nodiscard]] bool fits(const Dimension& one, const Dimension& other);
/// The dimension of a sum or difference of numbers that fit.
[[nodiscard]] Dimension of_sum(const Dimension& one, const Dimension& other);
/// power: 1 of a product, -1 of a quotient.
[[nodiscard]] Dimension of_product(const Dimension& one, const Dimension& other, int power);

}  // namespace tessera::checks
