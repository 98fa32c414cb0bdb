#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "spec/model/model.hpp"
#include "tessera/result.hpp"

namespace tessera::server {

/// The names that drivers can use in the simulated world, by their kind: {"actuator": ["wheel_left"], ...}.
/// Elements in the placed model of an agent have the names that its drivers use, without the agent. {}: there
/// is no MuJoCo world. Problem: the world cannot be opened.
///
/// Threads: any.
[[nodiscard]] Result<nlohmann::json> world_targets(const spec::Model& model,
                                                   const std::filesystem::path& project);

}  // namespace tessera::server
