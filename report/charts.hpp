#pragma once

#include <string>
#include <string_view>

#include "replay/timeline.hpp"
#include "report/report.hpp"

namespace tessera::report {

/// For the text of an element or an attribute. Control characters, which HTML forbids, become U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

/// For `src` and `href`.
[[nodiscard]] std::string data_uri(std::string_view mime, std::string_view bytes);

/// Each an <svg> element, styled by the page.
[[nodiscard]] std::string path_svg(const Drive& drive);
[[nodiscard]] std::string error_svg(const Drive& drive);
[[nodiscard]] std::string timeline_svg(const replay::Timeline& timeline);

}  // namespace tessera::report
