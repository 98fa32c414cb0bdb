#include "report/colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tessera::report {

Colour heat_colour(double share) {
  constexpr std::array<Colour, 4> stops = {
      {{0.13, 0.36, 0.62}, {0.10, 0.62, 0.60}, {0.96, 0.70, 0.20}, {0.84, 0.18, 0.15}}};
  const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double t = at - static_cast<double>(low);
  const Colour& a = stops.at(low);
  const Colour& b = stops.at(low + 1);
  return {std::lerp(a.red, b.red, t), std::lerp(a.green, b.green, t), std::lerp(a.blue, b.blue, t)};
}

std::string css_colour(const Colour& colour) {
  const auto byte = [](double part) {
    return static_cast<unsigned>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
  };
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(colour.red) & 0xffU,
                byte(colour.green) & 0xffU, byte(colour.blue) & 0xffU);
  return text.data();
}

}  // namespace tessera::report
