// One run of a system: the choices that it leaves open, and what happens.
#pragma once

#include <cstdint>
#include <vector>

#include "timing/system.hpp"

namespace tessera::timing {

/// The choices that are open in one iteration.
struct PlannedCall {
  Time takes = 0;
  std::int8_t order = 0;  ///< of those that can act at one instant, the smaller one goes first
  bool late = false;      ///< its wake-ups use up the latency

  bool operator==(const PlannedCall&) const = default;
};
/// Per subsystem, its calls in their order. Later ones take as short as they may.
using RunPlan = std::vector<std::vector<PlannedCall>>;

/// The events of a run that a chain is about.
struct RunLog {
  struct Call {
    Time release = 0;  ///< without a rate: when it may begin
    Time begin = 0, end = -1;
  };
  struct Write {
    Time at = 0;
    std::uint32_t call = 0;     ///< of the sender
    std::int64_t reading = -1;  ///< the call of the first subsystem that it is based on; -1: none
  };
  struct Read {
    Time at = 0;
    std::uint32_t write = 0;
  };
  struct Command {
    Time at = 0;
    std::uint32_t call = 0;  ///< of the last subsystem
    std::int64_t reading = -1;
  };
  std::vector<std::vector<Call>> calls;         ///< per subsystem
  std::vector<std::vector<Write>> writes;       ///< per channel of the chain
  std::vector<std::vector<Read>> reads;         ///< the same
  std::vector<std::vector<std::int64_t>> uses;  ///< the same: per call of the receiver, the read; -1: none
  std::vector<Command> commands;
  std::vector<bool> wakes_late;  ///< per subsystem: in a transfer, by the latency or by its processor
  bool is_whole = false;         ///< it was played to its end
};

}  // namespace tessera::timing
