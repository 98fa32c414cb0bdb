#include "cli/timing/time_texts.hpp"

#include <fmt/format.h>

namespace tessera::cli {

namespace {
/// round: to a multiple of the step.
template <class Round>
std::string four_digits(timing::Time ns, Round round) {
  struct Unit {
    timing::Time ns;
    const char* name;
  };
  for (const Unit unit : {Unit{1'000'000'000, "s"}, Unit{1'000'000, "ms"}, Unit{1'000, "us"}})
    if (ns >= unit.ns) {
      timing::Time step = unit.ns / 1000;
      while (ns / step >= 10'000) step *= 10;
      return fmt::format(
          "{:g} {}", static_cast<double>(round(ns, step) * step) / static_cast<double>(unit.ns), unit.name);
    }
  return fmt::format("{} ns", ns);
}
}  // namespace

std::string time_text(timing::Time ns) { return four_digits(ns, timing::ceil_div); }
std::string least_time_text(timing::Time ns) { return four_digits(ns, timing::floor_div); }

std::string without_members(const std::string& name) {
  std::string result;
  bool inside = false;
  for (const char c : name) {
    if (c == '[') inside = true;
    if (c == ']') inside = false;
    if (!inside || c == '[') result += c;
  }
  return result;
}

}  // namespace tessera::cli
