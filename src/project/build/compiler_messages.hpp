#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::project {

/// A position that a message of the compiler names.
struct SourcePlace {
  std::string file;
  std::uint32_t line = 0, column = 0;
};

/// An error of the compiler with what belongs to it.
struct CompilerError {
  SourcePlace at;
  std::string text;                  ///< quotes as in ASCII; without the types behind "aka"
  std::vector<SourcePlace> reached;  ///< from where: includes, instantiations, the notes of clang
  std::vector<std::string> notes;    ///< at most ten
  std::uint32_t length = 1;          ///< underlined columns
};

/// The errors in what g++ or clang has printed in English, in that order. Warnings do not count.
[[nodiscard]] std::vector<CompilerError> read_compiler_errors(std::string_view output);

}  // namespace tessera::project
