#include "spec/values/unit_conversion.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string_view>
#include <system_error>
#include <utility>

namespace tessera::spec {
namespace {

constexpr int largest_power = 9;

enum class UnitBase : std::uint8_t { metre, radian, second };

/// A unit of one quantity. The factors above and below the line stay apart, so that 36 km/h are 10 m/s exactly.
struct ConvertibleUnit {
  std::string_view name;
  double above, below;
  UnitBase base;
  int power = 1;
};
constexpr std::array convertible_units =
    std::to_array<ConvertibleUnit>({{"km", 1000, 1, UnitBase::metre},
                                    {"m", 1, 1, UnitBase::metre},
                                    {"cm", 1, 100, UnitBase::metre},
                                    {"mm", 1, 1000, UnitBase::metre},
                                    {"rad", 1, 1, UnitBase::radian},
                                    {"deg", std::numbers::pi, 180, UnitBase::radian},
                                    {"h", 3600, 1, UnitBase::second},
                                    {"min", 60, 1, UnitBase::second},
                                    {"s", 1, 1, UnitBase::second},
                                    {"ms", 1, 1e3, UnitBase::second},
                                    {"us", 1, 1e6, UnitBase::second},
                                    {"\u00b5s", 1, 1e6, UnitBase::second},
                                    {"ns", 1, 1e9, UnitBase::second},
                                    {"Hz", 1, 1, UnitBase::second, -1},
                                    {"kHz", 1e3, 1, UnitBase::second, -1}});

/// A product of units in m, rad and s.
struct Measure {
  double above = 1, below = 1;
  std::array<int, 3> powers{};  ///< by UnitBase

  void multiply(const ConvertibleUnit& unit, int power) {
    for (int count = 0; count < std::abs(power); ++count) {
      (power > 0 ? above : below) *= unit.above;
      (power > 0 ? below : above) *= unit.below;
    }
    powers[static_cast<std::size_t>(unit.base)] += power * unit.power;
  }
};

std::string_view unit_name(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Takes the power off the end of "s^2", "s2" or "s²"; nullopt: it is none.
std::optional<int> take_power(std::string_view& text) {
  for (const auto& [sign, power] :
       {std::pair{std::string_view("\u00b2"), 2}, {std::string_view("\u00b3"), 3}})
    if (text.ends_with(sign)) return text.remove_suffix(sign.size()), power;
  const std::size_t begin = text.find_last_not_of("-0123456789") + 1;
  if (begin == 0 || begin == text.size()) return 1;
  const std::string_view digits = text.substr(begin);
  int power = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), power);
  if (error != std::errc{} || end != digits.data() + digits.size() || std::abs(power) > largest_power)
    return std::nullopt;
  text = text.substr(0, begin);
  if (text.ends_with('^')) text.remove_suffix(1);
  return power;
}

/// Multiplies by "s^2", with that sign of the power. false: it is no unit that can be converted.
bool multiply(Measure& all, std::string_view factor, int sign) {
  factor = unit_name(factor);
  if (factor == "1") return true;
  const std::optional<int> written = take_power(factor);
  if (!written) return false;
  const auto* const unit = std::ranges::find(convertible_units, factor, &ConvertibleUnit::name);
  if (unit == convertible_units.end()) return false;
  all.multiply(*unit, *written * sign);
  return true;
}

std::optional<Measure> measure(std::string_view unit) {
  Measure all;
  for (int sign = 1;;) {
    const std::size_t mark = unit.find_first_of("/*");
    if (!multiply(all, unit.substr(0, mark), sign)) return std::nullopt;
    if (mark == std::string_view::npos) return all;
    sign = unit[mark] == '/' ? -1 : 1;
    unit.remove_prefix(mark + 1);
  }
}

}  // namespace

std::optional<double> converted(const Quantity& quantity, std::string_view unit) {
  const std::optional<Measure> from = measure(quantity.unit), to = measure(unit);
  if (!from || !to || from->powers != to->powers) return std::nullopt;
  return quantity.number * from->above * to->below / (from->below * to->above);
}

}  // namespace tessera::spec
