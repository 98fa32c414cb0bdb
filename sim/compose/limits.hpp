#pragma once

#include <optional>
#include <pugixml.hpp>

#include "tessera/result.hpp"

namespace tessera::sim {

/// The first count in the document that is negative where it must not be, or so large that the engine would
/// need more memory or time than a machine has. It allocates what it is told to.
[[nodiscard]] std::optional<Problem> gigantic_count(pugi::xml_node root);

}  // namespace tessera::sim
