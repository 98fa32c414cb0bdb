#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/project.hpp"

/// The user's drivers in the tables of the system.
namespace tessera::codegen {

struct DriverTables {
  struct Table {
    std::string rows;  ///< of CppDriver
    std::size_t size = 0;
  };
  std::string options;  ///< definitions of tables that the rows name; ends with an empty line
  Table real, simulated;
  std::string classes;  ///< names of the driver classes in the rows; ends with an empty line
  std::set<std::string> headers;
  std::vector<std::string> places;  ///< "spec.yaml:41", per row; first the real ones

  [[nodiscard]] bool empty() const { return places.empty(); }
};
[[nodiscard]] DriverTables driver_tables(const Project& project);

/// "extern const tessera::CppDriver real_drivers[3];"; empty if there are none, as in many controllers.
[[nodiscard]] std::string declaration_of(std::string_view name, const DriverTables::Table& drivers);

/// Whether some driver serves all real buffers of the unit, so that it needs the structure `Real`.
[[nodiscard]] bool has_whole_driver(const Project& project, const Unit& unit);

}  // namespace tessera::codegen
