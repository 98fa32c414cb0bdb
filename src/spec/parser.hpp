#pragma once

#include <optional>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads a specification (YAML) into a Model. Reports every mistake of the text to `out`. nullopt
/// if one of them is an error.
///
/// The files of `include` are read from out.folder(), and become included files of `out`.
///
/// Errors:  E0xx not a YAML text that this parser reads; E1xx names and structure; E2xx types and units;
///          E3xx wiring. docs/reference/diagnostics.md lists all of them.
/// Threads: any; it reads the included files.
[[nodiscard]] std::optional<Model> parse(diagnostics::Diagnostics& out);

}  // namespace tessera::spec
