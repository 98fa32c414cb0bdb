#pragma once

#include <cstddef>
#include <cstdint>

/// What the controller's word of a channel has room for, and so what a communication model may have.
/// SharedChannel says why. share/tessera/spec.schema.json repeats two of them; a test compares.
namespace tessera {

inline constexpr std::size_t most_shared_places = 10;
inline constexpr std::size_t most_needs = 10;  ///< different sets of shared places that one side takes
inline constexpr std::uint32_t most_slots = 16;

/// Of DDS, for channels between processes: a later domain does not have the UDP ports for all processes that one host
/// may have.
inline constexpr std::uint32_t last_domain = 230;

}  // namespace tessera
