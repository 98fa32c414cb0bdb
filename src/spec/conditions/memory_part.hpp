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
///
/// member: the value of `i` in a constant such as robot[i]; nullopt: it has none.
[[nodiscard]] std::optional<MemoryPart> memory_part(std::span<const Token> part,
                                                    const std::vector<Field>& memory,
                                                    std::optional<std::uint32_t> member = std::nullopt);

/// The number in the brackets "[3]" or "[i]", which are the last three of these tokens; nullopt: they are something
/// else.
[[nodiscard]] std::optional<std::uint32_t> index_at_end(std::span<const Token> tokens,
                                                        std::optional<std::uint32_t> member);

}  // namespace tessera::spec
