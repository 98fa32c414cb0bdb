#pragma once

#include <string>

#include "project/verification/pipeline.hpp"

/// The verdicts on a net from which a controller is made. They are proved once and
/// kept for the user (project::user_folder), not in the project.
namespace tessera::project {

/// "60s", "500ms", "2min" or seconds. Throws std::runtime_error, which names `option`, for anything else.
[[nodiscard]] double parse_seconds(const std::string& text, const std::string& option);

/// The verdicts on a net made by build: the kept ones if they had at least as much time for what is unknown,
/// otherwise new ones. A file of kept verdicts that cannot be read or written counts for nothing.
[[nodiscard]] verify::Report verify_or_recall(const Specification& specification, const Nets& nets,
                                              const VerificationGate& gate, Listener& listener);

}  // namespace tessera::project
