#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::project {

/// A function with a body that takes a Context as its first argument, as transition functions do.
struct ScannedFunction {
  std::string name;
  std::string space;  ///< "rover::robot::control": the namespaces around it, and those before its name
  std::uint32_t line = 0;
};

/// What the text of a C++ file shows without being compiled: comments and literals do not count; macros are
/// not replaced, and all branches of `#if` are looked at but those of `#if 0`.
struct SourceScan {
  std::vector<ScannedFunction> functions;
  std::map<std::string, std::size_t> ends;   ///< of a namespace: where its last block is closed
  std::map<std::string, std::size_t> words;  ///< identifiers outside of bodies and in macros: how often
  std::vector<std::string> includes;         ///< of the form #include "..."
  bool makes_names = false;                  ///< a macro joins names (##), which may make any
};

[[nodiscard]] SourceScan scan_source(const std::string& text);

}  // namespace tessera::project
