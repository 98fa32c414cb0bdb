// Real controllers of random specifications. The command makes them; they run in simulated time; the oracle's
// net replays their firings.
#pragma once

#include "compare.hpp"

namespace oracle {

struct ControllerRun {
  bool made = false;  // false: refused, for example because no function takes time
  int firings = 0;
  std::vector<Disagreement> disagreements;
};

/// Generates, builds and simulates the controller under `command.folder()` for one second, with
/// conditions drawn from `seed`.
ControllerRun run_controller(const Specification& specification, const Command& command, unsigned seed);

}  // namespace oracle
