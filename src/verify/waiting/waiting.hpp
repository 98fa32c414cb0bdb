#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "explore/watch.hpp"
#include "verify/circuits/circuit_criterion.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// What is known of subsystems that wait for each other.
struct WaitingReport {
  std::vector<bool> goes_on;  ///< per subsystem: proved to go on for ever, or until it ends
  std::string why_not;        ///< of the first group of which that is not proved
  bool complete = false;      ///< it was not cut short by a limit
  std::size_t stops = 0, traps = 0;
};

/// Proves that subsystems go on, whatever behaviours they have and whatever channels these use: whoever is
/// stuck for ever waits for somebody who is, and every cycle of such waits is excluded by a channel that
/// cannot be empty and full at once or by a trap. A group is cleared as a whole; nothing is said of one that
/// is not. Definitions, statement and proof: docs/waiting.md.
///
/// groups: no channel that holds up joins a subsystem of one to a subsystem outside it; subsystems in no
/// group are not judged.
/// Threads: pure. Time: linear in the structure for each trap, and that of a SAT solver; limits.time holds.
[[nodiscard]] WaitingReport judge_waiting(const CommunicationStructure& structure,
                                          std::span<const CircuitGroup* const> groups,
                                          const explore::Limits& limits);

/// Per channel of the structure: from every reachable marking it can be received from again, or its reader
/// can end; false: not known. goes_on: the subsystems that are known to.
[[nodiscard]] std::vector<bool> flowing_channels(const CommunicationStructure& structure,
                                                 const std::vector<bool>& goes_on);

}  // namespace tessera::verify
