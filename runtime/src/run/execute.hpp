#pragma once

#include <optional>
#include <string>

#include "recorder/run_tally.hpp"
#include "run/give_up.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// As the public execute. tally: counts what happens, if nothing is recorded; nullptr: nothing is counted.
/// give_up: what to do if user code never returns.
[[nodiscard]] std::optional<RunSummary> execute(const System& system, const RunOptions& options,
                                                RunTally* tally, const GiveUp& give_up, std::string& error);

}  // namespace tessera
