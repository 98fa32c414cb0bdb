#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "network/carrier.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The way in which a simulated network treats messages.
struct NetworkConditions {
  Duration delay = std::chrono::milliseconds(1);  ///< of every message
  Duration jitter{0};    ///< upper bound of an additional delay, evenly distributed; the order of messages
                         ///< remains
  double loss = 0;       ///< probability that a message is lost
  double duplicate = 0;  ///< probability that it arrives twice
  double reorder = 0;    ///< probability that later ones may overtake it: it takes up to ten times as long
};

/// Reads the value of `--network`: "delay=2ms,jitter=1ms,loss=0.1,duplicate=0.01,reorder=0.05"; a missing
/// name keeps its default.
///
/// Errors: an unknown name, an invalid time or probability: nullopt and `error`.
[[nodiscard]] std::optional<NetworkConditions> read_network(const std::string& text, std::string& error);

/// Two processes that cannot hear each other for a while.
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
