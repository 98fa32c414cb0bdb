#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codegen/codegen.hpp"
#include "codegen/conditions.hpp"
#include "codegen/driver_tables.hpp"
#include "codegen/project.hpp"

/// One function per generated file; each stands in the source of the same name.
namespace tessera::codegen {

[[nodiscard]] File types_header(const Project& project);
/// The header that the user includes, and the data that it shares with the conditions.
[[nodiscard]] std::vector<File> subsystem_headers(const Project& project, const Unit& unit);
[[nodiscard]] File subsystem_source(const Project& project, const Unit& unit, const NetVariants& variants,
                                    const Conditions& conditions);
[[nodiscard]] File subsystems_header(const Project& project);
[[nodiscard]] File system_header(const Project& project);
[[nodiscard]] File system_source(const Project& project, const Numbered<spec::ChannelId, ChannelPorts>& ports,
                                 const DriverTables& drivers);
[[nodiscard]] File drivers_source(const Project& project, const DriverTables& drivers);
/// The lines of the specification that messages about drivers name. It includes nothing.
[[nodiscard]] File driver_lines_source(const Project& project, const DriverTables& drivers);
[[nodiscard]] File testing_header(const Project& project);
[[nodiscard]] File main_source(const Project& project);
[[nodiscard]] File cmake_lists(const Project& project, const std::vector<File>& files);
[[nodiscard]] File format_style();

/// tessera::tables_version that the output is made for; the generated code states it.
inline constexpr int tables_version_made = 7;

/// Stands before the includes of a source that has no text of the user but conditions (tessera/time.hpp).
inline constexpr std::string_view only_durations = "#define TESSERA_ONLY_DURATIONS\n";

/// "robot.control.cpp": not "control.cpp", which is the user's, so that a breakpoint there means one line.
[[nodiscard]] std::string source_name(const Unit& unit);

}  // namespace tessera::codegen
