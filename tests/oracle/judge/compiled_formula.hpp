// Formulas of `properties` over one net: patterns of fleets written out, paths looked up.
#pragma once

#include <vector>

#include "flat_net.hpp"

namespace oracle {

/// A formula whose paths are sets of places: true of a marking that has a token in one of them.
struct Compiled {
  Formula::Kind kind = Formula::Kind::path;
  std::vector<int> places;
  std::vector<Compiled> parts;
  bool holds(const Marking& marking) const;
};

struct CompiledProperty {
  Compiled first, second;
};

/// The meaning of a property, once for every agent or every `i` that it concerns.
std::vector<CompiledProperty> compile(const Specification& specification, const FlatNet& net,
                                      const Property& property);

}  // namespace oracle
