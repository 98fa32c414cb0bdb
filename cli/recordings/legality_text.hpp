#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "replay/legality.hpp"
#include "tessera/recording.hpp"

namespace tessera::cli {

/// "legal: 120 firings of the net 1b2c in 3 recordings", on standard output, and "the run has failed: stopped:
/// ..." for each recording that says so: a run can be legal and have failed. Precondition: there is a recording.
void print_verdict(const replay::Legality& legality, std::span<const Recording> recordings);
/// {"verdict", "firings", "why"}, and "failures" if there are any
[[nodiscard]] nlohmann::json json_of(const replay::Legality& legality, std::span<const Recording> recordings);
/// The exit code of `tessera replay --check`.
[[nodiscard]] int exit_code_of(replay::Legality::Verdict verdict);

}  // namespace tessera::cli
