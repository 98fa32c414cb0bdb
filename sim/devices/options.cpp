#include "sim/devices/options.hpp"

#include <algorithm>
#include <cmath>

#include "tessera/nearest.hpp"

namespace tessera::sim {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& wanted) {
  throw DeviceError("option '" + name + "' must be " + wanted, "", name);
}

const char* quantity_in(std::string_view unit) {
  if (unit == "m") return "a length, such as 4 m";
  if (unit == "rad") return "an angle, such as 90 deg";
  if (unit == "s") return "a time, such as 20 ms";
  return "a number";
}

}  // namespace

const WorldOption* Options::find(const std::string& name) {
  asked_.push_back(name);
  const auto found = request_.options.find(name);
  return found == request_.options.end() ? nullptr : &found->second;
}

std::optional<double> Options::number(const std::string& name, std::string_view unit) {
  const WorldOption* const option = find(name);
  if (option == nullptr) return std::nullopt;
  const double* const number =
      option->is_list || option->values.empty() ? nullptr : std::get_if<double>(&option->values[0].value);
  if (number == nullptr || !std::isfinite(*number)) refuse(name, quantity_in(unit));
  const std::string& given = option->values[0].unit;
  if (!unit.empty() && !given.empty() && given != unit) refuse(name, quantity_in(unit));
  return *number;
}

double Options::number_from_zero(const std::string& name, double otherwise, std::string_view unit) {
  const double value = number(name, unit).value_or(otherwise);
  if (value < 0) refuse(name, "a number from 0 up");
  return value;
}

std::optional<int> Options::whole_number(const std::string& name, int least, int most) {
  const WorldOption* const option = find(name);
  if (option == nullptr) return std::nullopt;
  const double* const number =
      option->is_list || option->values.empty() ? nullptr : std::get_if<double>(&option->values[0].value);
  if (number == nullptr || !option->values[0].unit.empty() || *number != std::floor(*number) ||
      *number < least || *number > most)
    refuse(name, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  return static_cast<int>(*number);
}

std::vector<std::string> Options::names(const std::string& name) {
  const WorldOption* const option = find(name);
  if (option == nullptr) return {};
  std::vector<std::string> names;
  for (const WorldValue& value : option->values) {
    const auto* const text = std::get_if<std::string>(&value.value);
    if (text == nullptr || text->empty()) refuse(name, "a name, or a list of names");
    names.push_back(*text);
  }
  if (names.empty()) refuse(name, "a name, or a list of names");
  return names;
}

std::optional<std::string> Options::word(const std::string& name, const std::vector<std::string>& words) {
  const WorldOption* const option = find(name);
  if (option == nullptr) return std::nullopt;
  const auto* const text = option->is_list || option->values.empty()
                               ? nullptr
                               : std::get_if<std::string>(&option->values[0].value);
  if (text == nullptr || std::ranges::find(words, *text) == words.end()) {
    std::string list;
    for (const std::string& word : words) list += (list.empty() ? "" : " or ") + word;
    refuse(name, list);
  }
  return *text;
}

std::optional<std::vector<int>> Options::indices(const std::string& name, int last) {
  const WorldOption* const option = find(name);
  if (option == nullptr) return std::nullopt;
  std::vector<int> all;
  for (const WorldValue& value : option->values) {
    const double* const number = std::get_if<double>(&value.value);
    if (number == nullptr || *number != std::floor(*number) || *number < 0 || *number > last)
      refuse(name, "a whole number from 0 to " + std::to_string(last) + ", or a list of them");
    all.push_back(static_cast<int>(*number));
  }
  return all;
}

void Options::refuse_others() const {
  for (const auto& [name, option] : request_.options) {
    if (std::ranges::find(asked_, name) != asked_.end()) continue;
    const std::string near = did_you_mean(name, asked_).text;
    const std::string text = "'" + request_.kind + "' has no option '" + name + "'";
    if (asked_.empty()) throw DeviceError(text, "it has no options", name);
    throw DeviceError(text, near + (near.empty() ? "" : " ") + "its options: " + short_list(asked_), name);
  }
}

}  // namespace tessera::sim
