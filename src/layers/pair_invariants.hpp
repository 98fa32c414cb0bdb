#pragma once

#include <cstdint>
#include <vector>

#include "spec/model/communication_model.hpp"

namespace tessera::layers {

/// A sum over the memory of a channel that no firing of either side changes, however many behaviours use the
/// sides. `in` and `out` of a side weigh nothing: they belong to the behaviour as well.
struct PairInvariant {
  std::vector<std::int32_t> shared;         ///< weights, as CommunicationModel::shared
  std::vector<std::int32_t> send, receive;  ///< weights, as ModelSide::places
  std::int64_t total = 0;

  /// No weight is negative and the total is one: at most one of its places holds a token.
  [[nodiscard]] bool is_unit() const;
};

/// The invariants of a model that say something of its shared places, those that are units first. Closes each
/// side to a loop, computes the minimal semiflows of the pair, and takes the places of the loops out again:
/// each side holds one token, so that what is counted at `in` and `out` is what its other places do not hold.
///
/// Exponential at worst; stops with what is known by then where that would take long.
/// Source: Farkas' algorithm, as in Colom and Silva, *Convex geometry and semiflows in P/T nets*, 1991.
[[nodiscard]] std::vector<PairInvariant> pair_invariants(const spec::CommunicationModel& model);

}  // namespace tessera::layers
