#pragma once

#include <string>

#include "report/report.hpp"

namespace tessera::report {

/// "4.07 laps, line lost 0.00 s, ...": the most important figures in one line.
[[nodiscard]] std::string headline(const ReportInput& input);

/// The HTML page.
[[nodiscard]] std::string page(const ReportInput& input);

}  // namespace tessera::report
