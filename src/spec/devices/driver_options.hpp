#pragma once

#include <optional>
#include <string>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// Reads an option of a driver that is a C++ class: `true` or `false`; a number, also with a unit (`33 mm`)
/// or in hexadecimal (0x40); otherwise a text. A quoted value is a text.
///
/// Errors: E104 no scalar.
[[nodiscard]] std::optional<DriverOption> read_class_option(const Entry& entry, Diagnostics& out);

/// Reads an option of a device of the simulated world: `true` or `false`; a number, also with a unit, in m,
/// rad, s or Hz; a name; or a list of them. The world knows which of them an option needs.
///
/// Errors: E104 another form; E205 an unknown unit.
[[nodiscard]] std::optional<DriverOption> read_world_option(const Entry& entry, Diagnostics& out);

/// `text` with every {i} replaced by the number.
[[nodiscard]] std::string with_agent_number(std::string text, std::uint32_t number);

}  // namespace tessera::spec
