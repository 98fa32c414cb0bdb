// Overtime of a run: calls that took longer than declared, and threads that went on late. Its summary has it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/report.hpp"

namespace tessera::cli {

/// The behaviours with calls that took longer than their `takes`, in the order of the specification.
[[nodiscard]] std::vector<report::SlowCalls> slow_calls_of(const nlohmann::json& summary);

/// "overtime: robot.control.follow: 3 of 500 calls took longer than its takes of 8 ms; ...", a line for each, and a
/// line about the thread that went on latest.
[[nodiscard]] std::string overtime_text(const nlohmann::json& summary,
                                        const std::vector<report::SlowCalls>& slow_calls);
/// Each line stands further to the right.
[[nodiscard]] std::string indented(const std::string& lines);

}  // namespace tessera::cli
