#pragma once

#include <set>
#include <string>

#include "sim/mjcf/model_file.hpp"

/// The steps that make a document independent of its file. Each is done once, in this order.
namespace tessera::sim {

/// 1. Absolute file names; an asset without a name gets that of its file, which the engine would give it.
void make_files_absolute(pugi::xml_node root, const CompilerSettings& settings, const std::string& folder);
/// 2. Gives a name to every element that can have one and has none. Returns these names.
[[nodiscard]] std::set<std::string> name_all(pugi::xml_node root);
/// 3. Everything that the engine derives with the settings of <compiler> is written out, as `alone` has it.
void write_derived_values(pugi::xml_node root, const CompilerSettings& settings, const mjModel& alone);
/// 4. Orientations in radians, in the usual sequence of Euler angles.
void normalise_orientations(pugi::xml_node root, const CompilerSettings& settings);

}  // namespace tessera::sim
