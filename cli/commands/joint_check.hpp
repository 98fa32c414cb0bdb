#pragma once

#include <optional>
#include <string>
#include <vector>

#include "replay/legality.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli {

/// The recordings that an argument of `tessera replay` means: itself, or all of a folder that
/// `tessera run --deploy` has made.
[[nodiscard]] std::vector<std::string> recordings_of(const std::string& given);

/// Are the recordings a legal run of the net of the specification? One recording, or several of the processes
/// of a deployed system (replay/joint_legality.hpp). nullopt after the reason has been printed that there is
/// no net to check against, or that they cannot be judged together.
[[nodiscard]] std::optional<replay::Legality> check_against(const std::string& specification,
                                                            const std::vector<Recording>& recordings);

}  // namespace tessera::cli
