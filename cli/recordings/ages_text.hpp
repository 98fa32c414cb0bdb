// How old commands were, in recordings, as a table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "replay/times/measured_ages.hpp"

namespace tessera::cli {

/// names: of the recordings, for the worst cases.
[[nodiscard]] std::string ages_text(const std::vector<replay::AgesOfChain>& all,
                                    std::span<const std::string> names);

}  // namespace tessera::cli
