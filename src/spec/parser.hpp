#pragma once

#include <optional>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads a specification (YAML) into a Model. Reports every mistake of the text to `out`, then nullopt if any
/// was an error.
///
/// Errors:  E0xx the text is not YAML that we read; E1xx names and structure; E2xx types and units; E3xx
/// wiring.
///          docs/diagnostics.md is the catalogue.
/// Threads: pure.
[[nodiscard]] std::optional<Model> parse(diagnostics::Diagnostics& out);

/// The same for a text that may have errors: what could be understood of it, for those who show a file while
/// it is written. Of a model with errors, an index may be `none` or out of range, and things may be missing.
/// nullopt: it is not YAML that we read.
[[nodiscard]] std::optional<Model> parse_what_is_known(diagnostics::Diagnostics& out);

}  // namespace tessera::spec
