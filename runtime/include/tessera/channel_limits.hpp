#pragma once

#include <cstddef>
#include <cstdint>

/// The limits of the controller's atomic word of a channel, and so of a communication model. SharedChannel
/// explains them. share/tessera/spec.schema.json repeats two of them; a test compares.
namespace tessera {

inline constexpr std::size_t most_shared_places = 10;
inline constexpr std::size_t most_needs = 10;  ///< different sets of shared places that one side takes
inline constexpr std::uint32_t most_slots = 16;

/// The last DDS domain for channels between processes. A later one has too few UDP ports for the processes
/// that one host may have.
inline constexpr std::uint32_t last_domain = 230;

}  // namespace tessera
