#pragma once

#include <string>
#include <string_view>

#include "spec/model/model.hpp"

/// Memory with few values in generated code: the net changes it, everyone else reads it (tessera/kept.hpp).
namespace tessera::codegen {

/// "tessera::Kept<LentTo>", "tessera::Counter<0, 4>". Precondition: the cell has few values.
[[nodiscard]] std::string kept_type(const spec::Model& model, const spec::Subsystem& subsystem,
                                    const spec::Field& cell);

/// "{LentTo::a}", "{2}": the initializer of the cell; empty: it begins with its first value.
[[nodiscard]] std::string kept_initial(const spec::Model& model, const spec::Subsystem& subsystem,
                                       const spec::Field& cell);

/// The enumerations of all cells with values, inside `struct Memory`, with a blank line behind; empty: none.
[[nodiscard]] std::string kept_enumerations(const spec::Model& model, const spec::Subsystem& subsystem);

/// "Memory::LentTo nobody = Memory::LentTo::nobody;": what a condition means by the name of a value.
[[nodiscard]] std::string value_constant(const spec::Model& model, const spec::Subsystem& subsystem,
                                         std::string_view value);

}  // namespace tessera::codegen
