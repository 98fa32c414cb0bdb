#pragma once

#include <string>
#include <vector>

#include "project/process/deployment_watch.hpp"

namespace tessera::project {

/// A subsystem that waits for another.
struct WaitingStep {
  std::string subsystem, process;        ///< that waits
  std::string waits_for, other_process;  ///< the subsystem at the other end, and its process
  std::string channel;
  bool for_answer = false;  ///< that its value is taken; false: for a value
  double for_s = 0;         ///< so long so far

  /// "rover[0].control waits for gate.board: no answer for 3.2 s"
  [[nodiscard]] std::string text() const;
};

/// A chain of waits, from a subsystem that no other waits for (or one of a circle) to the one that does not
/// wait itself.
struct WaitingChain {
  std::vector<WaitingStep> steps;
  /// The state of the last one that is waited for: "gate is gone", "gate.board runs 'grant'".
  std::string end;
};

/// All chains of waits of at least `least_s`, the longest waits first. Shorter ones are part of usual work.
/// Each subsystem follows its earliest wait; a subsystem at which several chains meet is in each of them.
[[nodiscard]] std::vector<WaitingChain> waiting_chains(const DeploymentWatch& deployment, double least_s = 1);

}  // namespace tessera::project
