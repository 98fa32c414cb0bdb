#pragma once

#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

struct StructureOrder {
  /// old indices, each after those it uses; without those on cycles and those that use them
  std::vector<Index> sorted;
  /// each uses the next, the last one uses the first; no two share a member
  std::vector<std::vector<Index>> cycles;
};

/// Linear in structures and fields, without recursion.
[[nodiscard]] StructureOrder order_structures(const std::vector<Structure>& structures);

/// The structures in the order `sorted`, a permutation. The indices in their fields are changed to match.
[[nodiscard]] std::vector<Structure> reordered(std::vector<Structure> structures,
                                               const std::vector<Index>& sorted);

}  // namespace tessera::spec
