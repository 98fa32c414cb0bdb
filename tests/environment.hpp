#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace tessera {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif
#else
inline constexpr bool sanitized = false;
#endif

/// How many of \p cases a long test tries. Under a sanitizer, where each takes ten times as long, it is a tenth of them,
/// and at least one: the optimised build tries them all.
[[nodiscard]] constexpr std::uint64_t share_of(std::uint64_t cases) {
  return sanitized ? (cases + 9) / 10 : cases;
}

/// The first of \p cases, as many as a long test tries.
template <class Case, std::size_t count>
[[nodiscard]] constexpr std::span<const Case> share_of(const std::array<Case, count>& cases) {
  return std::span<const Case>(cases).first(share_of(std::uint64_t{count}));
}

/// The number in an environment variable: how long a test is to be. `otherwise`: it is not set.
[[nodiscard]] inline std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace tessera
