#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace tessera::server {

/// A number, or JSON's null if there is none.
inline nlohmann::json or_null(const std::optional<double>& number) {
  return number ? nlohmann::json(*number) : nlohmann::json(nullptr);
}

}  // namespace tessera::server
