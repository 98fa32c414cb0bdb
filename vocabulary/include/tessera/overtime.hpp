#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tessera {

/// The reaction of a subsystem to a call that took longer than its `takes`, or to a thread that went on later than
/// `latency` allows.
enum class Overtime : std::uint8_t {
  tell,  ///< it is told and counted
  fault  ///< the call fails when it returns
};

/// The names of the enumerators, as in specifications.
inline constexpr std::array<std::string_view, 2> overtime_names{"tell", "fault"};
static_assert(overtime_names.size() == static_cast<std::size_t>(Overtime::fault) + 1);

[[nodiscard]] constexpr std::string_view name_of(Overtime overtime) {
  return overtime_names[static_cast<std::size_t>(overtime)];
}

}  // namespace tessera
