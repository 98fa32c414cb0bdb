// Times that are measured in recordings: `tessera replay --ages` and `--takes`.
#pragma once

#include <string>
#include <vector>

namespace tessera::cli {

struct TimesOptions {
  std::vector<std::string> recordings;
  std::string spec;            ///< file
  std::string json;            ///< file, or "-"; empty: none
  double margin_percent = 20;  ///< of --takes
  bool write = false;          ///< --takes: into the specification
};

/// Prints how old commands were. Returns the exit code: `failed` if a time exceeds its bound.
int ages_command(const TimesOptions& options);

/// Prints the times that the recordings of real runs propose for `takes`, as a change of the specification, or writes
/// it. Returns the exit code: `failed` if nothing was measured, or the specification cannot be changed.
int takes_command(const TimesOptions& options);

}  // namespace tessera::cli
