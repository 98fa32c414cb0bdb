#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

/// Units as people write them: "5 cm", "36 km/h", "2 m/s^2". This is the only table of units.
///
/// Threads: pure functions.
namespace tessera {

/// A number and the text after it, trimmed. The views are into the text that was read.
struct Quantity {
  double number = 0;
  std::string_view digits;  ///< the number as written
  std::string_view unit;
};

/// nullopt if the text does not begin with a finite decimal number.
[[nodiscard]] std::optional<Quantity> split_quantity(std::string_view text);

/// A product of powers of m, rad and s.
struct Unit {
  /// One of this unit is above / below of the product. Both stay apart, so that 36 km/h are 10 m/s exactly.
  double above = 1, below = 1;
  std::array<int, 3> powers{};  ///< of m, rad, s

  [[nodiscard]] double factor() const { return above / below; }
};

/// One of m, km, cm, mm, um, rad, deg, s, ms, us, ns, min, h, Hz, kHz and MHz. nullopt: another text.
[[nodiscard]] std::optional<Unit> simple_unit(std::string_view name);

/// A product or quotient of simple units and 1, each with a power: m/s, m/s^2, m/s2, m/s/s, cm*cm, 1/s. It is
/// read from the left: m/s*s is m. nullopt: one of the units is no simple one.
[[nodiscard]] std::optional<Unit> read_unit(std::string_view text);

/// The name of the SI unit with these powers: "m/s^2" for cm/s/s, "Hz" for 1/s; empty: a plain number.
[[nodiscard]] std::string si_name(const Unit& unit);

/// A number in another unit of the same quantity: 5 cm in m is 0.05, 3 Hz in 1/s is 3. nullopt: one of the
/// units is not known, or they are of different quantities.
[[nodiscard]] std::optional<double> converted(double number, std::string_view from, std::string_view to);

}  // namespace tessera
