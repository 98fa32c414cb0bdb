#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "language/edits/edits.hpp"

namespace tessera::language {

/// The edits of a request (share/tessera/studio.schema.json, `Edit`): one, or a list of them. nullopt: they are of
/// another form.
[[nodiscard]] std::optional<std::vector<Edit>> edits_of(const nlohmann::ordered_json& json);

}  // namespace tessera::language
