#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

#include "tessera/value_text.hpp"

namespace tessera::server {

/// A number, bool or text; "inf", "-inf" or "nan" for numbers that JSON does not have.
[[nodiscard]] nlohmann::json json_of(const ValueLayout::ScalarValue& scalar);

/// A number, bool, text, list, or {field: value}. null: the bytes do not encode such a value.
[[nodiscard]] nlohmann::json json_of(const ValueLayout& layout, std::string_view bytes);

}  // namespace tessera::server
