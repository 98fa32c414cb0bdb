#pragma once

#include <optional>
#include <string>

#include "recorder/run_tally.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// As the public execute. tally: counts what happens, if nothing is recorded; nullptr: nothing is counted.
[[nodiscard]] std::optional<RunSummary> execute(const System& system, const RunOptions& options,
                                                RunTally* tally, std::string& error);

}  // namespace tessera
