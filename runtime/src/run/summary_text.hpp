#pragma once

#include <string>

#include "tessera/controller.hpp"

namespace tessera {

/// The result of a run as JSON.
[[nodiscard]] std::string summary_json(const RunSummary& summary, const RunOptions& options);

/// The result of a run in a few lines for people: how it ended and what each subsystem did.
[[nodiscard]] std::string summary_lines(const RunSummary& summary);

}  // namespace tessera
