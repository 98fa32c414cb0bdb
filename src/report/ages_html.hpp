#pragma once

#include <string>

#include "report/report.hpp"

namespace tessera::report {

/// The section about the age of commands, and about calls that took longer than their `takes`; empty: neither is known.
[[nodiscard]] std::string ages_html(const ReportInput& input);

}  // namespace tessera::report
