// Times that are measured in recordings: `tessera replay --ages`.
#pragma once

#include <string>
#include <vector>

namespace tessera::cli {

struct TimesOptions {
  std::vector<std::string> recordings;
  std::string spec;  ///< file
  std::string json;  ///< file, or "-"; empty: none
};

/// Prints how old commands were. Returns the exit code: `failed` if a time exceeds its bound.
int ages_command(const TimesOptions& options);

}  // namespace tessera::cli
