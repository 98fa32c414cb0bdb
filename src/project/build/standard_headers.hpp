#pragma once

#include <string>
#include <string_view>

namespace tessera::project {

/// "<cmath>" for "sqrt": the header of a usual name of the C++ library. "": unknown.
[[nodiscard]] std::string standard_header(std::string_view name);

}  // namespace tessera::project
