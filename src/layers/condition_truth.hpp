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

}  // namespace tessera::layers
