#pragma once

#include <string>

#include "explore/formula.hpp"
#include "net/property.hpp"

/// The properties of the author as formulas over places.
namespace tessera::verify {

[[nodiscard]] explore::Formula formula_of(const net::Statement& statement);

/// The markings that the claim speaks of: those in which `what` is true, or for `always` those in which
/// it is not.
[[nodiscard]] explore::Formula what_of(net::Property::Kind kind, const net::Claim& claim);

/// "robot[3]: no run reaches it"
[[nodiscard]] std::string complaint(net::Property::Kind kind, const net::Claim& claim);

}  // namespace tessera::verify
