#include "tessera/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <system_error>
#include <utility>

namespace tessera {
namespace {

constexpr int largest_power = 9;

enum class UnitBase : std::uint8_t { metre, radian, second };

struct NamedUnit {
  std::string_view name;
  double above, below;
  UnitBase base;
  int power = 1;
};
constexpr std::array named_units = std::to_array<NamedUnit>({{"km", 1000, 1, UnitBase::metre},
                                                             {"m", 1, 1, UnitBase::metre},
                                                             {"cm", 1, 100, UnitBase::metre},
                                                             {"mm", 1, 1000, UnitBase::metre},
                                                             {"um", 1, 1e6, UnitBase::metre},
                                                             {"\u00b5m", 1, 1e6, UnitBase::metre},
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
                                                             {"kHz", 1e3, 1, UnitBase::second, -1},
                                                             {"MHz", 1e6, 1, UnitBase::second, -1}});

void multiply(Unit& product, const Unit& unit, int power) {
  for (int count = 0; count < std::abs(power); ++count) {
    (power > 0 ? product.above : product.below) *= unit.above;
    (power > 0 ? product.below : product.above) *= unit.below;
  }
  for (std::size_t base = 0; base < product.powers.size(); ++base)
    product.powers[base] += power * unit.powers[base];
}

std::string_view trimmed_of(std::string_view text, std::string_view blanks) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
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

/// Multiplies by "s^2", with that sign of the power. false: it is no known unit.
bool multiply(Unit& product, std::string_view factor, int sign) {
  factor = trimmed_of(factor, " ");
  if (factor == "1") return true;
  const std::optional<int> written = take_power(factor);
  const std::optional<Unit> unit = written ? simple_unit(factor) : std::nullopt;
  if (!unit) return false;
  multiply(product, *unit, *written * sign);
  return true;
}

}  // namespace

std::optional<Quantity> split_quantity(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  text = trimmed_of(text, blanks);
  const bool plus = text.starts_with('+');
  const std::string_view digits = text.substr(plus ? 1 : 0);
  // from_chars also accepts "inf", "nan" and similar texts.
  const std::size_t first = digits.find_first_not_of("-.");
  if (first == std::string_view::npos || digits[first] < '0' || digits[first] > '9') return std::nullopt;
  Quantity result;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), result.number);
  if (error != std::errc() || !std::isfinite(result.number)) return std::nullopt;
  const auto length = static_cast<std::size_t>(end - digits.data());
  result.digits = digits.substr(0, length);
  result.unit = trimmed_of(digits.substr(length), blanks);
  return result;
}

std::optional<Unit> simple_unit(std::string_view name) {
  const auto* const found = std::ranges::find(named_units, name, &NamedUnit::name);
  if (found == named_units.end()) return std::nullopt;
  Unit unit{.above = found->above, .below = found->below};
  unit.powers[static_cast<std::size_t>(found->base)] = found->power;
  return unit;
}

std::optional<Unit> read_unit(std::string_view text) {
  Unit all;
  for (int sign = 1;;) {
    const std::size_t mark = text.find_first_of("/*");
    if (!multiply(all, text.substr(0, mark), sign)) return std::nullopt;
    if (mark == std::string_view::npos) return all;
    sign = text[mark] == '/' ? -1 : 1;
    text.remove_prefix(mark + 1);
  }
}

std::string si_name(const Unit& unit) {
  constexpr std::array<std::string_view, 3> bases{"m", "rad", "s"};
  if (unit.powers == std::array{0, 0, -1}) return "Hz";
  std::string above, below;
  for (std::size_t base = 0; base < bases.size(); ++base)
    if (const int power = unit.powers[base]; power != 0) {
      std::string& side = power > 0 ? above : below;
      side += (power < 0 ? "/" : side.empty() ? "" : "*") + std::string(bases[base]);
      if (std::abs(power) > 1) side += fmt::format("^{}", std::abs(power));
    }
  return (above.empty() && !below.empty() ? "1" : above) + below;
}

std::optional<double> converted(double number, std::string_view from, std::string_view to) {
  const std::optional<Unit> given = read_unit(from), wanted = read_unit(to);
  if (!given || !wanted || given->powers != wanted->powers) return std::nullopt;
  return number * given->above * wanted->below / (given->below * wanted->above);
}

}  // namespace tessera
