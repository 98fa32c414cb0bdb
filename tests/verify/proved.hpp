#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "verify/verify.hpp"

namespace tessera::verify {

/// The flat net of a specification and all verdicts on it.
struct Proved {
  net::Net net;
  Report report;

  [[nodiscard]] const PropertyResult& operator[](const std::string& name) const {
    return *std::ranges::find(report.properties, name, &PropertyResult::name);
  }
};
/// only: the names of the properties that are judged; none: all. method: the only one; none: all.
/// Throws std::runtime_error, with the diagnostics, of a text that is no specification.
[[nodiscard]] Proved proved(const std::string& text, std::chrono::seconds time = std::chrono::seconds(20),
                            const std::vector<std::string>& only = {}, const std::string& method = "");
/// Its waits in words.
[[nodiscard]] std::vector<std::string> texts_of(const PropertyResult& property);
[[nodiscard]] net::Net flattened(const std::string& text);

}  // namespace tessera::verify
