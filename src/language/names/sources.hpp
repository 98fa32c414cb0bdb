#pragma once

#include <string_view>
#include <vector>

#include "language/names/index.hpp"

/// The C++ of a project: where it uses names of the specification.
namespace tessera::language {

struct CodeUse {
  Extent extent;
  SymbolId symbol{};
  bool defines = false;      ///< the definition of a transition function
  bool sure = true;          ///< false: a member of that name, of something whose type only a compiler knows
  bool enumeration = false;  ///< the enumeration of a memory cell, which is named after the cell
};

/// All uses in a source that can be told from its words: in the namespace SYSTEM::DEFINITION::SUBSYSTEM the
/// transition functions, what `in`, `out`, `memory` and `parameters` hold, and names of structures; the
/// namespaces themselves; the enumerations of memory cells and their values; the generated headers that it
/// includes.
[[nodiscard]] std::vector<CodeUse> uses_in_code(const Index& index, std::string_view source);

/// The same for a file of parameters: `v: 0.2`, `robot.motor.r: 3 cm`.
[[nodiscard]] std::vector<CodeUse> uses_in_parameter_file(const Index& index, std::string_view text);

/// The same for the places of boxes in the drawing: `"robot.sensor": [4, 7]`.
[[nodiscard]] std::vector<CodeUse> uses_in_layout_file(const Index& index, std::string_view text);

}  // namespace tessera::language
