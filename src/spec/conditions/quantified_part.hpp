#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "spec/conditions/tokens.hpp"
#include "spec/model/endings.hpp"

namespace tessera::spec {

/// A part of a condition (PartTruth) over all buffers of one name, of which there is one for each member of a fleet:
/// "any(in.request.fresh)", "all(...)", "count(...) >= 2".
struct QuantifiedPart {
  std::span<const Token> word;        ///< any, all or count
  std::string owner;                  ///< "in"
  std::string family;                 ///< "request"
  std::string status;                 ///< "fresh"
  std::span<const Token> compared{};  ///< ">= 2"; empty: none

  /// The truth of the part, as far as those of its members are known.
  [[nodiscard]] Truth truth(const std::vector<Truth>& members) const;
};

/// nullopt: the part is something else.
[[nodiscard]] std::optional<QuantifiedPart> quantified_part(std::span<const Token> part);

/// The expression as C++ has it: any(in.request.fresh) becomes a call of tessera::any with a function.
///
/// families: names of the buffers of which there is one for each member.
[[nodiscard]] std::string with_cpp_quantifiers(std::string expression,
                                               const std::vector<std::string>& families);

}  // namespace tessera::spec
