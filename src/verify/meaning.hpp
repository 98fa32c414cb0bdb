#pragma once

#include <string>

#include "verify/verify.hpp"

namespace tessera::verify {

/// How a property speaks of runs and choices.
enum class Sort : std::uint8_t {
  universal,     ///< of every marking
  completeness,  ///< of every marking, that something can fire in it
  always_can,    ///< of every marking, that something can come of it
  follows,       ///< of some markings, that something always comes of them
  existential    ///< of some marking
};

/// What a verdict on a net whose conditions are free choices says about the net whose conditions choose.
/// Empty for unknown.
[[nodiscard]] std::string meaning_of(Verdict verdict, Sort sort);

}  // namespace tessera::verify
