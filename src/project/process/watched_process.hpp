#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "tessera/control_messages.hpp"

namespace tessera::project {

/// A process of a deployed system, as it is seen through its control socket or over the network.
struct WatchedProcess {
  using Clock = std::chrono::steady_clock;
  enum class State : std::uint8_t {
    running,
    silent,  ///< it sends nothing any more: it is stopped, or hangs
    ended,   ///< it has said so
    gone  ///< the connection ended without that, or the network has forgotten it: it has died, or was killed
  };
  State state = State::running;
  std::optional<Clock::time_point> since;  ///< of `state`; nullopt: it was so when it was found
  Clock::time_point heard;                 ///< its last line; if it has said nothing, when it was found
  std::string socket;                      ///< the file's name; over the network "network:NAME:INCARNATION"
  bool is_local = false;                   ///< a process of this machine, and not the end of a tunnel
  bool by_network = false;                 ///< any program on the network can have sent it
  /// The last one. It has the name of the process; if it has said nothing, only that and the process number.
  Snapshot snapshot;

  [[nodiscard]] const std::string& name() const { return *snapshot.process; }
  [[nodiscard]] bool is_there() const { return state == State::running || state == State::silent; }
};

/// "running", "silent", "ended", "gone"
[[nodiscard]] const char* name_of(WatchedProcess::State state);
/// A process that sends nothing for so long is silent. Usually it sends five times a second.
inline constexpr std::chrono::milliseconds longest_silence{2000};

}  // namespace tessera::project
