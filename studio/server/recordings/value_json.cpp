#include "server/recordings/value_json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

namespace tessera::server {

using nlohmann::json;
using ScalarValue = ValueLayout::ScalarValue;

json json_of(const ScalarValue& scalar) {
  switch (scalar.kind) {
    case ScalarValue::Kind::boolean:
      return scalar.integer != 0;
    case ScalarValue::Kind::integer:
      return scalar.integer;
    case ScalarValue::Kind::natural:
      return static_cast<std::uint64_t>(scalar.integer);
    case ScalarValue::Kind::real:
      if (!std::isfinite(scalar.number)) return scalar.shown();  // JSON has no such numbers
      return scalar.number;
    case ScalarValue::Kind::text:
      return scalar.text;
  }
  return nullptr;
}

namespace {

/// The element "points[3].x"; missing parts are made.
json& element(json& value, std::string_view path) {
  json* here = &value;
  while (!path.empty()) {
    if (path.front() == '[') {
      std::size_t index = 0;
      std::from_chars(path.data() + 1, path.data() + path.size(), index);
      here = &(*here)[index];
      path.remove_prefix(path.find(']') + 1);
    } else {
      path.remove_prefix(path.front() == '.' ? 1 : 0);
      const std::size_t end = std::min(path.find_first_of(".["), path.size());
      here = &(*here)[std::string(path.substr(0, end))];
      path.remove_prefix(end);
    }
  }
  return *here;
}

}  // namespace

json json_of(const ValueLayout& layout, std::string_view bytes) {
  json value;
  const bool whole = layout.visit(
      bytes,
      [&](const std::string& path, const ScalarValue& scalar) { element(value, path) = json_of(scalar); },
      [&](const std::string& path, std::size_t) { element(value, path) = json::array(); });
  return whole ? value : json(nullptr);
}

}  // namespace tessera::server
