#include "checks/dimension.hpp"

#include <optional>
#include <tuple>
#include <utility>

#include "tessera/units.hpp"

namespace tessera::checks {

using Known = Dimension::Known;

Dimension dimension_of_unit(std::string_view unit) {
  Dimension dimension{.known = Known::by_unit};
  if (const std::optional<Unit> read = read_unit(unit))
    std::tie(dimension.length, dimension.angle, dimension.time) = std::tuple_cat(read->powers);
  return dimension;
}

std::string unit_of(const Dimension& dimension) {
  return si_name(Unit{.powers = {dimension.length, dimension.angle, dimension.time}});
}

std::string name_of(const Dimension& dimension) {
  const std::string unit = unit_of(dimension);
  return unit.empty() ? "a plain number" : unit;
}

bool fits(const Dimension& one, const Dimension& other) {
  return one.known != Known::by_unit || other.known != Known::by_unit || one == other;
}

Dimension of_sum(const Dimension& one, const Dimension& other) {
  for (const Known known : {Known::by_unit, Known::never})
    for (const Dimension& side : {one, other})
      if (side.known == known) return side;
  return one;
}

Dimension of_product(const Dimension& one, const Dimension& other, int power) {
  for (const Dimension& side : {one, other})
    if (side.known == Known::never) return side;
  if (one.known == Known::bare && other.known == Known::bare) return one;
  return {Known::by_unit, one.length + power * other.length, one.angle + power * other.angle,
          one.time + power * other.time};
}

}  // namespace tessera::checks
