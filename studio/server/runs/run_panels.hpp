#pragma once

#include <nlohmann/json.hpp>

#include "server/runs/run.hpp"
#include "spec/model/model.hpp"

namespace tessera::server {

/// The panels of such a run: [{"path", "stale_s", "controls"}] of docs/reference/studio.md.
[[nodiscard]] nlohmann::json panels_of(const spec::Model& model, const RunRequest& request);

}  // namespace tessera::server
