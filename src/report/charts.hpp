#pragma once

#include <string>

#include "replay/timeline.hpp"
#include "report/report.hpp"

namespace tessera::report {

/// Each an <svg> element, styled by the page.
[[nodiscard]] std::string path_svg(const DrivenPath& drive);
[[nodiscard]] std::string error_svg(const DrivenPath& drive);
[[nodiscard]] std::string timeline_svg(const replay::Timeline& timeline);

}  // namespace tessera::report
