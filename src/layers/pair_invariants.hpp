#pragma once

#include <cstdint>
#include <vector>

#include "spec/model/communication_model.hpp"

namespace tessera::layers {

/// A weighted sum over the memory of a channel that no firing of either side changes, however many behaviours
/// use the sides. `in` and `out` of a side have weight zero: they belong to the behaviour as well.
struct PairInvariant {
  std::vector<std::int32_t> shared;         ///< weights, as CommunicationModel::shared
  std::vector<std::int32_t> send, receive;  ///< weights, as ModelSide::places
  std::int64_t total = 0;

  /// No weight is negative and the total is one: at most one of its places holds a token.
  [[nodiscard]] bool is_unit() const;
};

/// The invariants of a model that concern its shared places, unit invariants first. Closes each side to a
/// loop, computes the minimal semiflows of the pair, and removes the places of the loops again. Each side
/// holds one token, so this token is at `in` or `out` exactly if no other place of the side holds it.
///
/// Exponential at worst. Stops early if it would take long, and returns the invariants found by then.
/// Source: Farkas' algorithm, as in Colom and Silva, *Convex geometry and semiflows in P/T nets*, 1991.
[[nodiscard]] std::vector<PairInvariant> pair_invariants(const spec::CommunicationModel& model);

}  // namespace tessera::layers
