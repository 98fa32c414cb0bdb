#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "replay/statistics.hpp"
#include "tessera/recording.hpp"

/// The summary that `tessera replay` gives of a recording without other options.
namespace tessera::cli {

void print_summary(const Recording& recording, const std::vector<replay::SubsystemStatistics>& all);
[[nodiscard]] nlohmann::json summary_json(const Recording& recording,
                                          const std::vector<replay::SubsystemStatistics>& all);
/// The time at which a recording without its beginning begins; null: nothing is left in it.
[[nodiscard]] nlohmann::json recorded_from_s(const Recording& recording);

}  // namespace tessera::cli
