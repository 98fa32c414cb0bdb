#pragma once

#include <string_view>

#include "diagnostics/diagnostics.hpp"

namespace tessera::spec {

/// Whether `name` is allowed as a name in a specification. Names become C++ identifiers.
///
/// what: the thing, e.g. "buffer".
/// Errors: E105 no C++ identifier, too long, leading or double underscore; E106 a keyword of C++, a macro of
/// its library, or a name of the generated code.
bool check_name(std::string_view name, diagnostics::Span span, std::string_view what,
                diagnostics::Diagnostics& out);

/// The same for the name of the system, which becomes a namespace beside the functions of the C library.
bool check_system_name(std::string_view name, diagnostics::Span span, diagnostics::Diagnostics& out);

/// The same for the name of a behaviour, which becomes a function beside the types of its subsystem.
///
/// Errors: also E106 `end`.
bool check_behaviour_name(std::string_view name, diagnostics::Span span, diagnostics::Diagnostics& out);

/// A letter or underscore, then letters, digits and underscores.
[[nodiscard]] bool is_identifier(std::string_view text);

/// Whether C++ reserves the word in every scope.
[[nodiscard]] bool is_keyword(std::string_view word);

}  // namespace tessera::spec
