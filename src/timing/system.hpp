// The base of the bounds: subsystems that repeat one iteration, and the channels between them.
#pragma once

#include <cstdint>
#include <vector>

#include "time.hpp"

namespace tessera::timing {

/// An iteration: wait for the release, call the transition function, send, receive.
struct Subsystem {
  Time period = 0;                             ///< 0: no rate
  Time shortest = 1, longest = 1;              ///< of a call, without preemption. 0 < shortest <= longest
  bool catch_up = false;                       ///< releases that were missed are made up for
  bool parallel = false;                       ///< its transfers wait side by side
  std::vector<std::uint32_t> sends, receives;  ///< channels, in the order of the transfers
  int processor = -1;                          ///< -1: one of its own
  int priority = 0;                            ///< on that processor; the larger one goes first
  std::uint32_t process = 0;                   ///< only those of one process begin on a common grid
};

struct Channel {
  std::uint32_t from = 0, to = 0;  ///< subsystems
  bool send_blocks = false, receive_blocks = false;
  Time send_timeout = 0, receive_timeout = 0;  ///< 0: none
  /// Between processes: most time of a value, and of an acknowledgement, on the way. Nothing is lost or overtaken.
  Time network = 0;
};

struct System {
  std::vector<Subsystem> subsystems;
  std::vector<Channel> channels;
  Time latency = 0;  ///< most time from the moment that a sleeper may go on until it does

  [[nodiscard]] bool crosses(std::uint32_t channel) const {
    const Channel& one = channels[channel];
    return subsystems[one.from].process != subsystems[one.to].process;
  }
};

/// Channels, each of which ends where the next one begins. The device is read where the first one begins, and
/// commanded where the last one ends.
using Chain = std::vector<std::uint32_t>;

}  // namespace tessera::timing
