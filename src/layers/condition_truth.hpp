#pragma once

#include "net/net.hpp"
#include "spec/model/endings.hpp"

namespace tessera::layers {

/// Translates what the specification knows about a condition into the terms of the net.
[[nodiscard]] constexpr net::Condition::Truth truth(spec::Truth known) {
  switch (known) {
    case spec::Truth::free:
      return net::Condition::Truth::free;
    case spec::Truth::always:
      return net::Condition::Truth::always;
    case spec::Truth::never:
      return net::Condition::Truth::never;
  }
  return net::Condition::Truth::free;
}

[[nodiscard]] constexpr net::Condition::Truth negation(net::Condition::Truth known) {
  using Truth = net::Condition::Truth;
  if (known == Truth::free) return known;
  return known == Truth::always ? Truth::never : Truth::always;
}

}  // namespace tessera::layers
