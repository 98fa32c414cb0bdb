#pragma once

#include <cstdint>
#include <vector>

namespace tessera::test {

/// The steps of two sides and a network, as far as fairness is concerned.
struct FairGraph {
  enum class Kind : std::uint8_t { user, time_up, repeat, hello, read, arrival, loss, restart };
  static constexpr std::uint32_t no_message = UINT32_MAX;
  struct Edge {
    std::uint32_t to = 0;
    Kind kind = Kind::user;
    std::uint32_t sent = no_message, answered = no_message;  ///< messages that the step sends
    std::uint32_t got = no_message;                          ///< the message that arrives
  };
  struct Mark {
    bool pending = false;  ///< the sender sends again and again
    bool full = false;     ///< the receiver's user reads again and again
    bool alone = false;    ///< the receiver says again and again that it is there
  };
  std::vector<std::vector<Edge>> edges;
  std::vector<Mark> marks;
};

/// Whether there is an endless run within these states, without restarts and timeouts, in which every
/// repeated message arrives again and again, and both sides carry out their duties again and again. A state
/// without duties counts.
[[nodiscard]] bool has_fair_cycle(const FairGraph& graph, const std::vector<std::uint32_t>& within);

}  // namespace tessera::test
