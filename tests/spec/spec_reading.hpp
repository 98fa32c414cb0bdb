#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "spec/parser.hpp"

namespace tessera::spec {

/// A text and the result of the parser.
struct Reading {
  explicit Reading(const std::string& text) : diagnostics("spec.yaml", text), model(parse(diagnostics)) {}

  /// The codes in the order of the report: "E101 W316".
  [[nodiscard]] std::string codes() const {
    std::string result;
    for (const auto& one : diagnostics.sorted()) result += (result.empty() ? "" : " ") + one.code;
    return result;
  }
  [[nodiscard]] std::string report() const { return render(diagnostics); }

  diagnostics::Diagnostics diagnostics;
  std::optional<Model> model;
};

inline std::string text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline std::string golden(const std::string& path) {
  return text_of_file(std::string(TESSERA_SOURCE_DIR) + "/tests/golden/spec/" + path);
}

}  // namespace tessera::spec
