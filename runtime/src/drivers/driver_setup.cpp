#include "tessera/driver_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "tessera/units.hpp"

namespace tessera {
namespace {

/// "a number with the unit 'mm'"
[[nodiscard]] std::string description(const DriverOption& option) {
  if (std::holds_alternative<bool>(option.value)) return "true or false";
  if (std::holds_alternative<std::string_view>(option.value)) return "a text";
  return option.unit.empty() ? "a number" : fmt::format("a number with the unit '{}'", option.unit);
}

[[noreturn]] void refuse(const DriverOption& option, std::string_view wanted) {
  throw DriverError(
      fmt::format("option '{}' must be {}, and it is {}", option.name, wanted, description(option)));
}

[[nodiscard]] double number_of(const DriverOption& option, std::string_view unit) {
  const std::string wanted = unit.empty() ? "a number without a unit" : fmt::format("a number in {}", unit);
  const double* const number = std::get_if<double>(&option.value);
  if (number == nullptr) refuse(option, wanted);
  if (option.unit == unit || option.unit.empty()) return *number;
  const std::optional<double> wished = converted(*number, option.unit, unit);
  if (!wished) refuse(option, wanted);
  return *wished;
}

[[nodiscard]] Duration duration_of(const DriverOption& option) {
  constexpr double longest_s = 9e9;
  const double* const number = std::get_if<double>(&option.value);
  const std::optional<double> seconds =
      number == nullptr ? std::nullopt : converted(*number, option.unit, "s");
  if (!seconds) refuse(option, "a time such as 200 ms");
  const double length_s = *seconds;
  if (!(std::abs(length_s) < longest_s))
    throw DriverError(fmt::format("option '{}' is longer than any run", option.name));
  return Duration(std::llround(length_s * 1e9));
}

[[nodiscard]] std::int64_t integer_of(const DriverOption& option) {
  constexpr double largest = 9007199254740992.0;  // 2^53: above it doubles skip whole numbers
  const double number = number_of(option, "");
  if (number == std::floor(number) && std::abs(number) <= largest) return static_cast<std::int64_t>(number);
  throw DriverError(fmt::format("option '{}' must be a whole number, and it is {}", option.name, number));
}

[[nodiscard]] std::string text_of(const DriverOption& option) {
  if (const auto* const text = std::get_if<std::string_view>(&option.value)) return std::string(*text);
  throw DriverError(fmt::format("option '{}' must be a text, and it is {}; write it in quotes", option.name,
                                description(option)));
}

[[nodiscard]] bool flag_of(const DriverOption& option) {
  if (const bool* const flag = std::get_if<bool>(&option.value)) return *flag;
  refuse(option, "true or false");
}

}  // namespace

DriverSetup::DriverSetup(std::string path, std::vector<DriverOption> options,
                         std::shared_ptr<WorldState> world)
    : path_(std::move(path)), options_(std::move(options)), world_(std::move(world)) {
  const std::size_t first = path_.find('.');
  agent_ = path_.substr(0, first);
  if (first != std::string::npos) {
    const std::size_t second = path_.find('.', first + 1);
    subsystem_ = path_.substr(first + 1, second == std::string::npos ? second : second - first - 1);
    if (second != std::string::npos) buffer_ = path_.substr(second + 1);
  }
  const std::size_t bracket = agent_.find('[');
  if (bracket == std::string::npos) return;
  std::uint32_t index = 0;
  const auto [end, problem] =
      std::from_chars(agent_.data() + bracket + 1, agent_.data() + agent_.size(), index);
  if (problem == std::errc{}) index_ = index;
}

std::shared_ptr<WorldState> DriverSetup::world() const {
  if (world_ != nullptr) return world_;
  throw DriverError("the driver needs a simulated world, and there is none: name `world:` in `simulation:`");
}

const DriverOption* DriverSetup::find(std::string_view name) const {
  if (std::find(asked_.begin(), asked_.end(), name) == asked_.end()) asked_.emplace_back(name);
  const auto found = std::find_if(options_.begin(), options_.end(),
                                  [&](const DriverOption& option) { return option.name == name; });
  return found == options_.end() ? nullptr : &*found;
}

const DriverOption& DriverSetup::get(std::string_view name) const {
  if (const DriverOption* const option = find(name)) return *option;
  std::vector<std::string_view> given;
  for (const DriverOption& option : options_) given.push_back(option.name);
  throw DriverError(given.empty()
                        ? fmt::format("option '{}' is missing", name)
                        : fmt::format("option '{}' is missing; given are {}", name, fmt::join(given, ", ")));
}

bool DriverSetup::has(std::string_view option) const { return find(option) != nullptr; }

double DriverSetup::number(std::string_view option, std::string_view unit) const {
  return number_of(get(option), unit);
}
double DriverSetup::number_or(std::string_view option, double otherwise, std::string_view unit) const {
  const DriverOption* const found = find(option);
  return found == nullptr ? otherwise : number_of(*found, unit);
}
std::int64_t DriverSetup::integer(std::string_view option) const { return integer_of(get(option)); }
std::int64_t DriverSetup::integer_or(std::string_view option, std::int64_t otherwise) const {
  const DriverOption* const found = find(option);
  return found == nullptr ? otherwise : integer_of(*found);
}
std::string DriverSetup::text(std::string_view option) const { return text_of(get(option)); }
std::string DriverSetup::text_or(std::string_view option, std::string_view otherwise) const {
  const DriverOption* const found = find(option);
  return found == nullptr ? std::string(otherwise) : text_of(*found);
}
bool DriverSetup::flag(std::string_view option) const { return flag_of(get(option)); }
bool DriverSetup::flag_or(std::string_view option, bool otherwise) const {
  const DriverOption* const found = find(option);
  return found == nullptr ? otherwise : flag_of(*found);
}
Duration DriverSetup::duration(std::string_view option) const { return duration_of(get(option)); }
Duration DriverSetup::duration_or(std::string_view option, Duration otherwise) const {
  const DriverOption* const found = find(option);
  return found == nullptr ? otherwise : duration_of(*found);
}

std::vector<std::string> DriverSetup::unknown_options() const {
  std::vector<std::string> unknown;
  for (const DriverOption& option : options_)
    if (std::find(asked_.begin(), asked_.end(), option.name) == asked_.end())
      unknown.emplace_back(option.name);
  return unknown;
}

void refuse_unknown_options(const DriverSetup& setup, bool takes_setup) {
  const std::vector<std::string> unknown = setup.unknown_options();
  if (unknown.empty()) return;
  throw DriverError(fmt::format(
      fmt::runtime(takes_setup
                       ? "the driver has no option '{}'"
                       : "the driver has no option '{}': its class has no constructor that takes a const "
                         "tessera::DriverSetup&"),
      fmt::join(unknown, "', '")));
}

}  // namespace tessera
