#pragma once

#include <string>

#include "spec/document/document.hpp"

namespace tessera::spec {

/// A C++ expression, trimmed. This function checks only what would break the structure of the generated
/// code. The compiler checks the rest and names the line of the specification.
///
/// Errors: E209 brackets or quotes that do not match, ';', a comment, a preprocessor line.
[[nodiscard]] std::string expression_text(const Node& text, Diagnostics& out);

}  // namespace tessera::spec
