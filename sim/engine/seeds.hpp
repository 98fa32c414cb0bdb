#pragma once

#include <cstdint>
#include <string_view>

namespace tessera::sim {

/// Derives a seed for a name from the seed of the run. The result is the same on every machine, unlike
/// std::hash.
[[nodiscard]] constexpr std::uint64_t seed_of(std::string_view name, std::uint64_t run) {
  std::uint64_t hash = run * 0x9e3779b97f4a7c15ULL + 14695981039346656037ULL;
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211ULL;
  return hash;
}

}  // namespace tessera::sim
