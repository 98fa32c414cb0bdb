#pragma once

#include <filesystem>

#include "diagnostics/diagnostics.hpp"
#include "spec/model/model.hpp"

namespace tessera::project {

/// Whether the files that the simulation names exist: the world, and the picture of the track.
///
/// project: the folder of the specification.
/// Errors: E310 a file is neither in that folder nor among the shipped ones.
bool check_simulation_files(const spec::Model& model, const std::filesystem::path& project,
                            diagnostics::Diagnostics& out);

}  // namespace tessera::project
