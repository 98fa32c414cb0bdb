#pragma once

#include <string>

namespace tessera {

/// What a simulated run was judged by, and what it tells, as lines for people: "  check nobody touches: held".
/// json: an object with `checks` and `measures`, such as the summary of a run (docs/worlds.md). Empty: neither
/// is there, or the text is no such object.
[[nodiscard]] std::string judgement_lines(const std::string& json);

}  // namespace tessera
