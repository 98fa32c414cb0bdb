#pragma once

#include <string_view>

/// Names that the C and C++ libraries use.
namespace tessera::spec {

/// Whether a header of the C or C++ library defines a macro `name`. A macro
/// replaces the name in every scope.
[[nodiscard]] bool is_macro(std::string_view name);

/// Whether a namespace `name` of a system would clash: with something in the global namespace that is not a
/// namespace, or with the namespace of a library that controllers link.
[[nodiscard]] bool is_global_name(std::string_view name);

}  // namespace tessera::spec
