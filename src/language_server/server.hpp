#pragma once

#include <filesystem>

/// The Language Server Protocol (3.17) over src/language: `tessera lsp`.
namespace tessera::language_server {

struct Options {
  std::filesystem::path schema;  ///< share/tessera/spec.schema.json
  int in = 0, out = 1;           ///< file descriptors
};

/// Serves one editor until it says `exit` or closes `in`. Returns the exit code of the program: 0 if the editor
/// asked for `shutdown` before, else 1 (as the protocol says).
///
/// Throws std::runtime_error if the schema cannot be read.
[[nodiscard]] int serve(const Options& options);

}  // namespace tessera::language_server
