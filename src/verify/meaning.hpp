#pragma once

#include <string>

#include "verify/verify.hpp"

namespace tessera::verify {

/// The form of a property: which markings it speaks of, and what it says of them.
enum class Sort : std::uint8_t {
  universal,     ///< something is true in every marking
  completeness,  ///< something can fire in every marking
  always_can,    ///< something can be reached from every marking
  follows,       ///< something always follows some markings
  existential    ///< something is true in some marking
};

/// The consequence of a verdict on the abstract net, whose conditions are free choices, for the executed net,
/// whose conditions choose. Empty for unknown.
[[nodiscard]] std::string meaning_of(Verdict verdict, Sort sort);

}  // namespace tessera::verify
