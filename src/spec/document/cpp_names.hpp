#pragma once

#include <string_view>

/// Names that the C and C++ libraries take.
namespace tessera::spec {

/// Whether some header of the C or C++ library defines a macro `name`: in every scope it means something
/// else.
[[nodiscard]] bool is_macro(std::string_view name);

/// Whether `name` is something in the global namespace other than a namespace, where a system's namespace
/// would stand beside it, or the namespace of a library that controllers link.
[[nodiscard]] bool is_global_name(std::string_view name);

}  // namespace tessera::spec
