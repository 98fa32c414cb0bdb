#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "replay/legality.hpp"

namespace tessera::cli {

/// "legal: 120 firings of the net 1b2c in 3 recordings", on standard output.
void print_verdict(const replay::Legality& legality, const std::string& net_hash, std::size_t recordings);
/// {"verdict", "firings", "why"}
[[nodiscard]] nlohmann::json json_of(const replay::Legality& legality);
/// The exit code of `tessera replay --check`.
[[nodiscard]] int exit_code_of(replay::Legality::Verdict verdict);

}  // namespace tessera::cli
