// Calls of a real run that took longer than the specification declares.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/report.hpp"
#include "spec/model/model.hpp"

namespace tessera::cli {

/// One for each behaviour with such calls, in the order of the specification. None: all calls were in time, the run was
/// simulated, or nothing is declared or recorded. Reads a recording of any length piece by piece.
[[nodiscard]] std::vector<report::SlowCalls> slow_calls_in(const std::string& recording,
                                                           const spec::Model& model);

/// "overtime: robot.control.follow: 3 of 500 calls took longer than its takes of 8 ms; ...", a line for each.
[[nodiscard]] std::string slow_calls_text(const std::vector<report::SlowCalls>& all);
[[nodiscard]] nlohmann::json slow_calls_json(const std::vector<report::SlowCalls>& all);

}  // namespace tessera::cli
