#include "cli/timing/time_texts.hpp"

#include <fmt/format.h>

namespace tessera::cli {

std::string time_text(timing::Time ns) {
  struct Unit {
    timing::Time ns;
    const char* name;
  };
  for (const Unit unit : {Unit{1'000'000'000, "s"}, Unit{1'000'000, "ms"}, Unit{1'000, "us"}})
    if (ns >= unit.ns) {
      timing::Time step = unit.ns / 1000;
      while (ns / step >= 10'000) step *= 10;
      return fmt::format(
          "{:g} {}", static_cast<double>(timing::ceil_div(ns, step) * step) / static_cast<double>(unit.ns),
          unit.name);
    }
  return fmt::format("{} ns", ns);
}

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
