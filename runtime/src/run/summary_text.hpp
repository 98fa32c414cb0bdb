#pragma once

#include <string>

#include "tessera/controller.hpp"

namespace tessera {

/// What a run came to, as JSON for machines.
[[nodiscard]] std::string summary_json(const RunSummary& summary, const RunOptions& options);

/// A few lines for people: how it ended and what each subsystem did.
[[nodiscard]] std::string summary_lines(const RunSummary& summary);

}  // namespace tessera
