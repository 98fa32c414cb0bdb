#pragma once

#include "tessera/recording.hpp"

/// Names of files that Tessera finds again in the folder of a project or of a run.
namespace tessera::project::file_names {

inline constexpr const char* specification = "spec.yaml";
inline constexpr const char* parameters = "params.yaml";
inline constexpr const char* layout = ".tessera-layout.json";  ///< the boxes that were moved in the studio
inline constexpr const char* state_folder = ".tessera";        ///< of the project

// In the folder of a run.
inline constexpr const char* recording = recording_file_name;
inline constexpr const char* notes_ending =
    ".notes.json";  ///< RECORDING.notes.json: what the user says about it
inline constexpr const char* summary = "summary.json";
inline constexpr const char* deployment = "deployment.json";  ///< of several processes
inline constexpr const char* simulation = "simulation.json";  ///< devices of the world, for the controller

}  // namespace tessera::project::file_names
