#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tessera {

/// The reaction of a subsystem with a rate to instants that it missed because its own work took too long.
enum class Overrun : std::uint8_t {
  skip,      ///< leaves them out
  catch_up,  ///< runs the missed iterations late, one after the other
  fault      ///< leaves them out; the next iteration, which is late, fails without calling its function
};

/// The names of the enumerators, as in specifications.
inline constexpr std::array<std::string_view, 3> overrun_names{"skip", "catch_up", "fault"};
static_assert(overrun_names.size() == static_cast<std::size_t>(Overrun::fault) + 1);

[[nodiscard]] constexpr std::string_view name_of(Overrun overrun) {
  return overrun_names[static_cast<std::size_t>(overrun)];
}

}  // namespace tessera
