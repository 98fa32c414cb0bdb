#pragma once

#include <string>
#include <vector>

#include "sim/mjcf/model_file.hpp"

namespace tessera::sim {

/// Adds a warning for each option that a model file sets and that differs in the world, whose options apply,
/// if it changes how the model moves.
void add_option_conflicts(const ModelFile& file, const ModelFile& world, std::vector<std::string>& warnings);

}  // namespace tessera::sim
