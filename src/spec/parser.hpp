#pragma once

#include <optional>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads a specification (YAML) into a Model. Reports every mistake of the text to `out`. nullopt
/// if one of them is an error.
///
/// Errors:  E0xx not a YAML text that this parser reads; E1xx names and structure; E2xx types and units;
///          E3xx wiring. docs/reference/diagnostics.md lists all of them.
/// Threads: pure.
[[nodiscard]] std::optional<Model> parse(diagnostics::Diagnostics& out);

/// The same for a text that may have errors, as an editor shows it: returns all parts that could be
/// understood. In a model with errors, an index may be `none` or out of range, and parts may be missing.
/// nullopt: the text is not YAML that this parser reads.
[[nodiscard]] std::optional<Model> parse_what_is_known(diagnostics::Diagnostics& out);

}  // namespace tessera::spec
