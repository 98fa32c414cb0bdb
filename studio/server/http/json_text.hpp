#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tessera::server {

/// The text in one line. Bytes that are not UTF-8, for example those of a quoted file, are replaced.
template <class Json>
[[nodiscard]] std::string text_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tessera::server
