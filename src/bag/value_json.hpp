#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "tessera/value_text.hpp"

namespace tessera::bag {

/// A recorded value as a JSON object; one that is no structure is its member `value`. Numbers that are not
/// finite become null, because JSON has none. nullopt: the bytes do not encode such a value.
[[nodiscard]] std::optional<std::string> json_of(const ValueLayout& layout, std::string_view bytes);

/// The JSON Schema of these objects. units: by path, as the fields of the value stand in the specification:
/// "v", "points.x"; "" for a value that is no structure.
[[nodiscard]] std::string schema_of(const ValueLayout& layout, const std::string& title,
                                    const std::map<std::string, std::string>& units);

/// A text as JSON has it, with its quotes. Bytes that are no UTF-8 are replaced.
[[nodiscard]] std::string json_text(std::string_view text);

}  // namespace tessera::bag
