#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "spec/model/model.hpp"

/// The texts of conditions as C++.
namespace tessera::codegen {

/// The expression at a column; further lines of a block text at the same one.
///
/// families: names of the buffers of which there is one for each member of a fleet.
[[nodiscard]] std::string at_column(const spec::Expression& expression, std::uint32_t column,
                                    const std::vector<std::string>& families);

/// The buffers of which there is one for each member of a fleet.
[[nodiscard]] std::vector<std::string> buffer_families(const spec::Subsystem& subsystem);

/// Whether a condition names something of the standard library, or calls a function that is no member. Such a
/// condition gets headers that most do not need.
[[nodiscard]] bool calls_library(const spec::Expression& expression);

/// "memory.n < 4 && memory.m > 0": the changes of the entry are possible. Empty: they always are.
[[nodiscard]] std::string allowed_text(const spec::Subsystem& subsystem, const spec::Next& entry);

}  // namespace tessera::codegen
