#pragma once

#include <vector>

#include "spec/model/model.hpp"

namespace tessera::spec {

using Structures = Numbered<StructureId, Structure>;

struct StructureOrder {
  /// old numbers, each after those it uses; without those on cycles and those that use them
  std::vector<StructureId> sorted;
  /// each uses the next, the last one uses the first; no two share a member
  std::vector<std::vector<StructureId>> cycles;
};

/// Linear in structures and fields, without recursion.
[[nodiscard]] StructureOrder order_structures(const Structures& structures);

/// The structures in the order `sorted`, a permutation. The numbers in their fields are changed to match.
[[nodiscard]] Structures reordered(Structures structures, const std::vector<StructureId>& sorted);

}  // namespace tessera::spec
