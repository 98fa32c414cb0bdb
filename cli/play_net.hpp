#pragma once

#include <cstdint>
#include <string>

namespace tessera::cli {

struct PlayOptions {
  std::string file;  ///< PNML
  std::uint64_t steps = 1'000'000;
  std::uint64_t seed = 1;
  std::string json;  ///< file for the result; "-": standard output; empty: none
};

/// Plays a net that has no controller: fires randomly chosen enabled transitions until the
/// steps are used up, no transition is enabled, or Ctrl-C. Prints what fired, how often and how
/// fast. Returns the exit code.
[[nodiscard]] int play_net(const PlayOptions& options);

}  // namespace tessera::cli
