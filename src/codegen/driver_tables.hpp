#pragma once

#include <set>
#include <string>

#include "codegen/project.hpp"

/// The user's drivers in the tables of the system.
namespace tessera::codegen {

struct DriverTables {
  std::string options;          ///< definitions of tables that the rows name; ends with an empty line
  std::string real, simulated;  ///< rows of CppDriver; empty: none
  std::string classes;          ///< names of the driver classes in the rows; ends with an empty line
  std::set<std::string> headers;
};
[[nodiscard]] DriverTables driver_tables(const Project& project);

/// Whether some driver serves all real buffers of the unit, so that it needs the structure `Real`.
[[nodiscard]] bool has_whole_driver(const Project& project, const Unit& unit);

}  // namespace tessera::codegen
