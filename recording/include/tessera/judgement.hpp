#pragma once

#include <string>

namespace tessera {

/// The checks and measures of a simulated run and their results, as lines for people:
/// "  check nobody touches: held". json: an object with `checks` and `measures`, such as the summary of a
/// run (docs/use/worlds.md), and what its behaviours have `used`. Empty: the object has none of these, or the text is
/// no such object.
[[nodiscard]] std::string judgement_lines(const std::string& json);

}  // namespace tessera
