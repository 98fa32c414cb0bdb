#pragma once

#include <optional>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// A `terminal` or `error` condition. entry may be null: the condition never holds.
///
/// Errors: E104 neither bool nor text nor map; E105/E106/E107 names of expressions; E209 no C++ expression.
[[nodiscard]] Condition read_condition(const Entry* entry, Diagnostics& out);

/// The value of `when:` in behaviour `of`, whose conditions have been read.
///
/// Errors: E101 a name that is no condition of the behaviour; E104; E209.
[[nodiscard]] When read_when(const Entry& entry, const Behaviour& of, Diagnostics& out);

}  // namespace tessera::spec
