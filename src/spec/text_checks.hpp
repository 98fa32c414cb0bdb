#pragma once

#include "diagnostics/diagnostics.hpp"

namespace tessera::spec {

/// Whether out.text() is text at all.
///
/// Errors: E003 control characters (a binary file), E004 not UTF-8. Reports the first.
[[nodiscard]] bool check_text(diagnostics::Diagnostics& out);

}  // namespace tessera::spec
