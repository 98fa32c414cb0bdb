#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "spec/conditions/tokens.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// A part of a condition (PartTruth) that a memory cell with few values decides.
struct MemoryPart {
  std::uint32_t cell = 0;     ///< into the memory
  std::vector<bool> holds{};  ///< per value of the cell, whether the part is true
};

/// A comparison of such a cell with a constant, on either side, or a counter alone: it is not zero. nullopt: the
/// part is something else.
[[nodiscard]] std::optional<MemoryPart> memory_part(std::span<const Token> part,
                                                    const std::vector<Field>& memory);

}  // namespace tessera::spec
