#pragma once

#include <cstdint>
#include <cstdlib>

namespace tessera {

/// The number in an environment variable: how long a test is to be. `otherwise`: it is not set.
[[nodiscard]] inline std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace tessera
