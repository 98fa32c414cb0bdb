#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "network/carrier.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// What a simulated network does to messages.
struct NetworkConditions {
  Duration delay = std::chrono::milliseconds(1);  ///< of every message
  Duration jitter{0};    ///< a message takes up to so much longer, evenly distributed; their order remains
  double loss = 0;       ///< probability that a message is lost
  double duplicate = 0;  ///< that it arrives twice
  double reorder = 0;    ///< that later ones may overtake it: it takes up to ten times as long
};

/// Reads the value of `--network`: "delay=2ms,jitter=1ms,loss=0.1,duplicate=0.01,reorder=0.05"; what is left
/// out keeps its default.
///
/// Errors: an unknown name, a time or probability that is none: nullopt and `error`.
[[nodiscard]] std::optional<NetworkConditions> read_network(const std::string& text, std::string& error);

/// Two processes that do not hear each other for a while.
struct Cut {
  network::ProcessNumber one = 0, other = 0;
  Time from{}, until{};
};

/// A process that is dead for a while. Time::max(): it does not begin again.
struct Outage {
  network::ProcessNumber process = 0;
  Time from{}, until{};
};

}  // namespace tessera
