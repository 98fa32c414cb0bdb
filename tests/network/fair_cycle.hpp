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

/// Is there an endless run within these states, without restarts, and times that are up, in which every message that is
/// sent again and again arrives again and again, and both sides do again and again what they have to? A state
/// in which nothing is left to do counts.
[[nodiscard]] bool has_fair_cycle(const FairGraph& graph, const std::vector<std::uint32_t>& within);

}  // namespace tessera::test
