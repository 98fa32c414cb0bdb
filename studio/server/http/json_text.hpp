#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tessera::server {

/// One line; bytes that are not UTF-8, such as those of a file quoted, are replaced.
template <class Json>
[[nodiscard]] std::string text_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tessera::server
