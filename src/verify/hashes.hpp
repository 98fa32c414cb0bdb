#pragma once

#include <string>

#include "verify/verify.hpp"

namespace tessera::verify {

/// The identity of a net, as the runtime computes it: 32 hex digits.
[[nodiscard]] std::string hash_of(const net::Net& net);

/// The identity of what was verified: net, constants, properties with their verdicts, version of the checker.
[[nodiscard]] std::string hash_of_verification(const net::Net& net, const Report& report);

}  // namespace tessera::verify
