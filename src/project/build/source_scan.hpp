#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::project {

/// A function with a body that returns nothing, or says so behind its arguments.
struct ScannedFunction {
  std::string name;
  /// "rover::robot::control": the namespaces around it, and those written before its name
  std::string space;
  std::uint32_t line = 0;
  std::string heading;  ///< "void follow(Context& context)"; on one line, without comments
};

/// Lines from the opening to the closing brace.
struct ScannedBody {
  std::uint32_t first = 0, last = 0;
};

/// The contents of a C++ file, as far as its text shows them. Comments and literals do not count; macros are
/// not expanded; all branches of `#if` count except those of `#if 0`.
struct SourceScan {
  std::vector<ScannedFunction> functions;  ///< their first argument is a Context&, as in transition functions
  std::vector<ScannedFunction> others;     ///< with other arguments
  std::vector<ScannedBody> bodies;         ///< of functions and classes, without those inside of them
  std::map<std::string, std::size_t> ends;  ///< for each namespace, where its last block is closed
  /// number of occurrences of identifiers outside of bodies and in macros
  std::map<std::string, std::size_t> words;
  std::vector<std::string> includes;  ///< of the form #include "..."
  bool makes_names = false;           ///< a macro joins names (##), which may make any name
};

[[nodiscard]] SourceScan scan_source(const std::string& text);

}  // namespace tessera::project
