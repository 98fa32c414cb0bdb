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
  std::string why;            ///< illegal, incomplete: the reason, in one line
  std::uint64_t firings = 0;  ///< the number found legal
  /// Tokens of each place of the net after these firings.
  std::vector<std::uint32_t> marking;
};

/// Is the recorded run a firing sequence of the net? The recording is played on the net, one token at a time;
/// nothing of the runtime's own firing is used. Transitions are matched by name.
///
/// The events of one subsystem are ordered, and so are those of one channel, by the version that each of them
/// carries. A simulated run has the order of the file. For a run with threads, any order that keeps these two
/// is as good as another: firings that share no place commute, and firings that share one belong to one
/// subsystem or to one channel.
///
/// Threads: pure. Linear in the recording.
/// Source: enabling and firing, paper, sec. II.
[[nodiscard]] Legality check_legal(const Recording& recording, const net::Net& net);

}  // namespace tessera::replay
