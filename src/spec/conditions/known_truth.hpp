#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "spec/conditions/tokens.hpp"
#include "spec/model/endings.hpp"

namespace tessera::spec {

/// The truth of a part of an expression that has no logical operator outside brackets: "in.grant.fresh",
/// "memory.lent_to == nobody". Its tokens have no brackets around the whole.
using PartTruth = std::function<Truth(std::span<const Token>)>;

/// The truth of a condition as far as the truths of its parts decide it (Kleene): conjunctions, disjunctions and
/// negations, with `&&` or `and`, and with brackets. A choice (`?:`), an assignment or a comma outside all brackets
/// makes the whole free.
///
/// Precondition: brackets and quotes match. `part` is asked about every part, also where the others decide.
[[nodiscard]] Truth truth_of(std::string_view expression, const PartTruth& part);

}  // namespace tessera::spec
