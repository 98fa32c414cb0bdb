#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "tessera/controller.hpp"
#include "tessera/subsystem.hpp"
#include "tessera/time.hpp"

/// Values in the form in which people write them on a command line. `tessera` reads them before it builds a
/// controller; the controller reads them when it starts.
namespace tessera {

/// "60s", "1.5 min", "200ms", "2h", "90" (seconds). nullopt: none of these, or negative.
[[nodiscard]] std::optional<Duration> parse_duration(std::string text);

/// "500MB" (in four segments), "100MBx5" (so many of that size); B, kB, MB, GB. nullopt: none of these.
[[nodiscard]] std::optional<RunOptions::Limit> parse_record_limit(std::string text);

/// The parameters of one subsystem, and where they are stored.
struct ParameterOwner {
  std::string path;  ///< "robot[3].control"
  std::span<const Bindings::Parameter> parameters;
};

/// Sets parameters in order. PATH is a name (every subsystem that has it), or the path of an agent or a
/// subsystem and a name; `[*]` in the path stands for any index. The value of an array is "[1, 2, 3]".
/// A number may have any unit of the quantity of its parameter (tessera/units.hpp).
///
/// Errors: a path that names nothing (with the nearest that does), a value of another kind or out of range.
///         Reports all, one per line, and returns false. Correct assignments take effect all the same.
[[nodiscard]] bool set_parameters(std::span<const ParameterOwner> owners,
                                  std::span<const std::pair<std::string, std::string>> values,
                                  std::string& error);

}  // namespace tessera
