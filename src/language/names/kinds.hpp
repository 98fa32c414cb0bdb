#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "language/names/index.hpp"

/// Questions of the builder of the index about one name.
namespace tessera::language {

/// The kind of the third word of a path.
enum class Place : std::uint8_t { agent, from, to, real, formula, chain };

[[nodiscard]] bool is_nothing(const Node& node);

/// The type of a name as the file has it: "float64 m/s"; empty: it has none.
[[nodiscard]] std::string type_of(Kind kind, const Node& value);

/// The fleet of "each robot"; empty: the text has another form.
[[nodiscard]] std::string_view fleet_in(std::string_view each);
/// The fleet for each of whose members there is one such buffer or behaviour; empty: it is one.
[[nodiscard]] std::string fleet_of(Kind kind, const Node& value, std::string_view type);

/// The names of a subsystem among which the third word of a path is. A formula names behaviours, and buffers that have
/// no behaviour of their name: `robot.control.line.full`. A chain names buffers.
[[nodiscard]] const NamesOf& members(const UnitNames& unit, Place place, std::string_view name);

}  // namespace tessera::language
