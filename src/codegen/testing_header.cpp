#include <fmt/format.h>

#include <set>

#include "codegen/cpp_text.hpp"
#include "codegen/emit.hpp"

namespace tessera::codegen {

File testing_header(const Project& project) {
  std::set<std::string> headers{"subsystems.hpp", "system.hpp"};
  std::string units;
  for (const Unit& unit : project.units) {
    headers.insert(unit_header(unit));
    units +=
        fmt::format("TESSERA_UNIT(::{}, ::{}, {});\n", unit_namespace(project.model, unit),
                    generated_namespace(unit), unit.subsystem->period ? unit.subsystem->period->count() : 0);
  }
  std::string includes;
  for (const std::string& header : headers) includes += fmt::format("#include \"{}\"\n", header);
  return {"tessera_testing.hpp", fmt::format(R"({0}#pragma once

#include <tessera/testing.hpp>

{1}
// For tests: what belongs to the Context of each kind of subsystem, and the controller (tessera/testing.hpp).
// clang-format off
namespace tessera {{
{2}
inline const System& generated_system() {{ return tessera_generated::system(); }}
}}  // namespace tessera
// clang-format on
)",
                                             project.banner(), includes, units)};
}

}  // namespace tessera::codegen
