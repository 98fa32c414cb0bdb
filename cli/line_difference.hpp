#pragma once

#include <string>
#include <string_view>

namespace tessera::cli {

/// "-" or "+" before the lines of a text; the last one may have no end.
[[nodiscard]] std::string marked(char mark, std::string_view text);

/// The lines that differ, in groups: "line 3", those before with -, those after with +. Lines are counted in `before`.
///
/// Shape: quadratic in the lines between the first and the last that differ; if these are very many, they are one group.
[[nodiscard]] std::string line_difference(std::string_view before, std::string_view after);

}  // namespace tessera::cli
