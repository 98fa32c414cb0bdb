#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "explore/watch.hpp"
#include "verify/circuits/circuit_criterion.hpp"
#include "verify/communication/communication.hpp"

namespace tessera::verify {

/// The result of judge_waiting.
struct WaitingReport {
  std::vector<bool> goes_on;  ///< per subsystem: proved to go on for ever, or until it ends
  std::string why_not;        ///< for the first group that is not proved
  bool complete = false;      ///< it was not cut short by a limit
  std::size_t stops = 0, traps = 0;
};

/// Proves that subsystems go on, whatever behaviours they have and whatever channels these use. A subsystem
/// that is stuck for ever waits for another one that is stuck for ever. Every cycle of such waits is excluded
/// by a channel that cannot be empty and full at once, or by a trap. A group is proved as a whole or not at
/// all. Definitions, statement and proof: docs/theory/waiting.md.
///
/// groups: no channel at which a subsystem may have to wait joins a group to a subsystem outside it.
/// Subsystems in no group are not judged.
/// Threads: pure. Time: linear in the structure for each trap, and that of a SAT solver; limits.time holds.
[[nodiscard]] WaitingReport judge_waiting(const CommunicationStructure& structure,
                                          std::span<const CircuitGroup* const> groups,
                                          const explore::Limits& limits);

/// For each channel of the structure: can it be received from again from every reachable marking, or can its
/// reader end? false: not known. goes_on: the subsystems that are known to go on.
[[nodiscard]] std::vector<bool> flowing_channels(const CommunicationStructure& structure,
                                                 const std::vector<bool>& goes_on);

}  // namespace tessera::verify
