#pragma once

#include <optional>
#include <string>

#include "recorder/run_tally.hpp"
#include "run/give_up.hpp"
#include "tessera/controller.hpp"

namespace tessera {

/// As the public execute. tally: counts the events of a run that is not recorded; nullptr: they are not
/// counted. give_up: the action if user code never returns.
[[nodiscard]] std::optional<RunSummary> execute(const System& system, const RunOptions& options,
                                                RunTally* tally, const GiveUp& give_up, std::string& error);

}  // namespace tessera
