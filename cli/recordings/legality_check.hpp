#pragma once

#include <optional>
#include <string>
#include <vector>

#include "replay/legality.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli {

/// The recordings for an argument of `tessera replay`: itself, or all in a folder that `tessera run --deploy`
/// has made, or all bags in a folder.
[[nodiscard]] std::vector<std::string> recordings_of(const std::string& given);

/// Checks that the recordings are a legal run of the net of the specification: one recording, or several of
/// the processes of a deployed system (replay/legality.hpp). nullopt: there is no net to check against,
/// or they cannot be judged together; the reason has been printed.
[[nodiscard]] std::optional<replay::Legality> check_against(const std::string& specification,
                                                            const std::vector<Recording>& recordings);

}  // namespace tessera::cli
