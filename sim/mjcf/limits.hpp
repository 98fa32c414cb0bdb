#pragma once

#include <optional>
#include <pugixml.hpp>

#include "tessera/result.hpp"

namespace tessera::sim {

/// The first number in the document that the engine cannot handle: a count that is negative, or so large that
/// it would need more memory or time than a machine has (the engine allocates without a check); not a number;
/// or beyond 1e30.
[[nodiscard]] std::optional<Problem> unusable_number(pugi::xml_node root);

}  // namespace tessera::sim
