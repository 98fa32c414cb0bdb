#pragma once

#include <cstddef>

#include "diagnostics/diagnostics.hpp"

namespace tessera::spec {

/// No specification written by people or programs has longer ones, and reading them takes seconds.
inline constexpr std::size_t longest_line = std::size_t{1024} * 1024;

/// Whether out.text() is text at all.
///
/// Errors: E003 control characters (a binary file), E004 not UTF-8, E011 a line longer than longest_line
/// bytes.
///         Reports the first of its kind only.
[[nodiscard]] bool check_text(diagnostics::Diagnostics& out);

}  // namespace tessera::spec
