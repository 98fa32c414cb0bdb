#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "spec/model.hpp"

namespace tessera::server {

/// Reads the bytes of a buffer as generated code lays them out: numbers, bool, BoundedString and arrays of
/// them, structures of those.
class ValueReader {
 public:
  explicit ValueReader(const spec::Model& model);
  /// hex: the bytes in hexadecimal. A number, bool, text, list, or {field: value}; null: no such buffer, or
  /// bytes of another size.
  [[nodiscard]] nlohmann::json read(const std::string& path, std::string_view hex) const;

 private:
  struct Layout {
    std::size_t size = 0, alignment = 1;
  };
  [[nodiscard]] Layout element_layout(const spec::Type& type) const;
  [[nodiscard]] Layout layout(const spec::Type& type) const;
  [[nodiscard]] nlohmann::json element(const spec::Type& type, std::span<const unsigned char> bytes) const;
  [[nodiscard]] nlohmann::json value(const spec::Type& type, std::span<const unsigned char> bytes) const;

  const spec::Model& model_;
  std::map<std::string, const spec::Type*> types_;
};

}  // namespace tessera::server
