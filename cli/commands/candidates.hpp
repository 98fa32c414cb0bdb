#pragma once

#include <string>
#include <vector>

#include "cli/arguments.hpp"

namespace tessera::cli {

/// What may follow on a command line, for the completion of shells.
struct Candidates {
  std::vector<std::string> words;
  bool files = false;  ///< a name of a file: the shell knows better
};

/// The candidates for the last of `typed`, the words behind the name of the program; it may be empty.
///
/// Pages, parameters and properties come from the specification that the line names, or that of the folder.
/// Silent and quick: nothing is verified, and a specification with errors has none of them.
[[nodiscard]] Candidates candidates(const CommandLine& line, std::vector<std::string> typed);

}  // namespace tessera::cli
