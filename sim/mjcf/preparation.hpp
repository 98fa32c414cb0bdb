#pragma once

#include <set>
#include <string>

#include "sim/mjcf/model_file.hpp"

/// The steps that make a document independent of its file. Each is done once, in this order.
namespace tessera::sim {

/// 1. Makes file names absolute. An asset without a name is named after its file, as the engine would do.
void make_files_absolute(pugi::xml_node root, const CompilerSettings& settings, const std::string& folder);
/// 2. Names every element that can have a name and has none. Returns these names.
[[nodiscard]] std::set<std::string> name_all(pugi::xml_node root);
/// 3. Writes out everything that the engine derives from the settings of <compiler>, as in `alone`.
void write_derived_values(pugi::xml_node root, const CompilerSettings& settings, const mjModel& alone);
/// 4. Writes orientations in radians, in the default sequence of Euler angles.
void normalise_orientations(pugi::xml_node root, const CompilerSettings& settings);

}  // namespace tessera::sim
