#pragma once

#include <nlohmann/json.hpp>

#include "spec/model/model.hpp"

namespace tessera::server {

/// The system in the terms of robotics: agents, subsystems, behaviours, buffers, channels, with the lines of
/// the specification (docs/reference/studio.md, `structure`).
///
/// model: may come from a text with errors (spec::parse_what_is_known).
[[nodiscard]] nlohmann::ordered_json structure_json(const spec::Model& model);

/// "float64[8] m/s"
[[nodiscard]] std::string type_text(const spec::Model& model, const spec::Type& type);

}  // namespace tessera::server
