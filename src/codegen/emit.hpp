#pragma once

#include <string>
#include <vector>

#include "codegen/codegen.hpp"
#include "codegen/project.hpp"

/// One function per generated file; each stands in the source of the same name.
namespace tessera::codegen {

[[nodiscard]] File types_header(const Project& project);
[[nodiscard]] File subsystem_header(const Project& project, const Unit& unit);
[[nodiscard]] File subsystem_source(const Project& project, const Unit& unit, const NetVariants& variants);
[[nodiscard]] File subsystems_header(const Project& project);
[[nodiscard]] File system_header(const Project& project);
[[nodiscard]] File system_source(const Project& project,
                                 const Numbered<spec::ChannelId, ChannelPorts>& ports);
[[nodiscard]] File testing_header(const Project& project);
[[nodiscard]] File main_source(const Project& project);
[[nodiscard]] File cmake_lists(const Project& project);
[[nodiscard]] File format_style();

/// tessera::tables_version that the output is made for; the generated code states it.
inline constexpr int tables_version_made = 5;

/// "robot.control.cpp": not "control.cpp", which is the user's, so that a breakpoint there means one line.
[[nodiscard]] std::string source_name(const Unit& unit);

}  // namespace tessera::codegen
