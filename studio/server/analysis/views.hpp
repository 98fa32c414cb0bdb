#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "project/files/world_views.hpp"

namespace tessera::server {

/// {"views": [{"path", "type", "kind", ...}...]} of docs/reference/studio.md.
[[nodiscard]] nlohmann::json json_of(const std::vector<project::WorldView>& views);

}  // namespace tessera::server
