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
  /// "rover::robot::control": the namespaces around it, and those written before its name
  std::string space;
  std::uint32_t line = 0;
};

/// The contents of a C++ file, as far as its text shows them. Comments and literals do not count; macros are
/// not expanded; all branches of `#if` count except those of `#if 0`.
struct SourceScan {
  std::vector<ScannedFunction> functions;
  std::map<std::string, std::size_t> ends;  ///< for each namespace, where its last block is closed
  /// number of occurrences of identifiers outside of bodies and in macros
  std::map<std::string, std::size_t> words;
  std::vector<std::string> includes;  ///< of the form #include "..."
  bool makes_names = false;           ///< a macro joins names (##), which may make any name
};

[[nodiscard]] SourceScan scan_source(const std::string& text);

}  // namespace tessera::project
