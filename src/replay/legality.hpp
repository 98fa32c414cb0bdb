#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {

struct Legality {
  enum class Verdict : std::uint8_t {
    legal,
    illegal,
    incomplete  ///< legal as far as it goes, but events are missing: the rest cannot be judged
  } verdict = Verdict::legal;
  std::string why;            ///< of illegal and incomplete, in one line
  std::uint64_t firings = 0;  ///< that were found legal
  /// Tokens of each place of the net after them.
  std::vector<std::uint32_t> marking;
};

/// Is the recorded run a firing sequence of the net? The recording is played on the net, one token at a time;
/// nothing of the runtime's own firing is used. Transitions are matched by name.
///
/// The events of one subsystem have their order, and so have those of one channel, by the version that each
/// of them carries; a simulated run has the order of the file. Of a run of threads any order that keeps the
/// first two is as good as another: firings that share no place commute, and those that share one are of one
/// subsystem or of one channel.
///
/// Threads: pure. Linear in the recording.
/// Source: enabling and firing, paper, sec. II.
[[nodiscard]] Legality check_legal(const Recording& recording, const net::Net& net);

}  // namespace tessera::replay
