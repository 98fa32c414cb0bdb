#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tessera::sim {

/// "no site 'eye_lef'; there are eye_left, eye_middle, eye_right; did you mean 'eye_left'?".
[[nodiscard]] std::string unknown_name(std::string_view what, std::string_view name,
                                       const std::vector<std::string>& known);

}  // namespace tessera::sim
