#pragma once

#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

struct StructureOrder {
  std::vector<Index> sorted;  ///< old indices, each after those it uses; without those on or above cycles
  std::vector<std::vector<Index>> cycles;  ///< each uses the next, the last the first; none shares a member
};

/// Linear in structures and fields, without recursion.
[[nodiscard]] StructureOrder order_structures(const std::vector<Structure>& structures);

/// The structures in that order, with the indices in their fields changed to match. sorted: a permutation.
[[nodiscard]] std::vector<Structure> reordered(std::vector<Structure> structures,
                                               const std::vector<Index>& sorted);

}  // namespace tessera::spec
