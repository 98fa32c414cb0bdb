#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tessera {

/// The types of single numbers and bools, as specifications and recordings name them.
enum class Scalar : std::uint8_t {
  boolean,
  int8,
  int16,
  int32,
  int64,
  uint8,
  uint16,
  uint32,
  uint64,
  float32,
  float64
};

/// The names of the enumerators in specifications and recordings.
inline constexpr std::array<std::string_view, 11> scalar_names{
    "bool", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "float32", "float64"};
static_assert(scalar_names.size() == static_cast<std::size_t>(Scalar::float64) + 1);

/// "bool", "float64"
[[nodiscard]] constexpr std::string_view name_of(Scalar scalar) {
  return scalar_names[static_cast<std::size_t>(scalar)];
}

/// The bytes of a value, in C++ and in a recording.
[[nodiscard]] constexpr std::uint64_t bytes_of(Scalar scalar) {
  constexpr std::array<std::uint8_t, scalar_names.size()> bytes{1, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8};
  return bytes[static_cast<std::size_t>(scalar)];
}

}  // namespace tessera
