#pragma once

#include <string>
#include <vector>

#include "cli/arguments.hpp"

namespace tessera::cli {

/// The possible continuations of a command line, for the completion of shells.
struct Candidates {
  std::vector<std::string> words;
  bool files = false;  ///< a name of a file: the shell completes it
};

/// The candidates for the last of `typed`, the words behind the name of the program; it may be empty.
///
/// Pages, parameters and properties come from the specification that the line names, or from the one of the
/// folder. It prints no message and is quick: it verifies nothing, and a specification with errors gives no
/// candidates.
[[nodiscard]] Candidates candidates(const CommandLine& line, std::vector<std::string> typed);

}  // namespace tessera::cli
