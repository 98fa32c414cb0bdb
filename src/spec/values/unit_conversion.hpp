#pragma once

#include <optional>
#include <string_view>

#include "spec/values/quantities.hpp"

namespace tessera::spec {

/// The number in another unit of the same quantity: 5 cm in m is 0.05, 36 km/h in m/s is 10, 3 Hz in 1/s is 3.
/// A unit is a product or quotient of km, m, cm, mm, rad, deg, h, min, s, ms, us, ns, Hz, kHz and 1, each with
/// a power: m/s^2, m/s2, m/s/s, cm*cm. nullopt: one of the units is another one, or they are of different
/// quantities.
[[nodiscard]] std::optional<double> converted(const Quantity& quantity, std::string_view unit);

}  // namespace tessera::spec
