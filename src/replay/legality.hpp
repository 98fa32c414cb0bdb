#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "replay/deployed_net.hpp"
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
  /// Tokens of each place of the net after these firings; 0 for the places of a channel between processes,
  /// whose tokens nobody records.
  std::vector<std::uint32_t> marking;
};

/// Is it a recording of a deployed system, or of one of its processes?
[[nodiscard]] bool is_of_deployed(const Recording& recording);

/// Why these recordings cannot be judged together: two of one process and incarnation, a process that the
/// system does not have, a run of a whole system beside others; nullopt: they can.
[[nodiscard]] std::optional<std::string> cannot_be_joined(std::span<const Recording> recordings,
                                                          const ProcessMap& processes);

/// Are these recordings one legal run of the net? Either one recording of a run of the whole system, or any
/// number of those of the processes of a deployed system; several of one process are its starts. The
/// recordings are played on the net, one token at a time; nothing of the runtime's own firing is used.
/// Transitions and places are matched by name.
///
/// A run under the simulated clock has the order of the file. Otherwise, the firings of one subsystem are
/// ordered, and so are those of one channel within a process, by the version that each of them carries. A
/// value of a channel between processes is written before it is read, and its read has ended before its sender
/// fires that it knows. Any order that keeps these is as good as another: firings that share no place commute,
/// and firings that share one belong to one subsystem or to one channel. Times of different recordings are not
/// compared.
///
/// A recording whose beginning is gone is judged from the first marking on that it holds.
///
/// incomplete: a recording is cut off, has lost events, has no marking to begin with, or is not given. Then
/// all that is given was checked as far as possible.
///
/// processes: empty for a system that is not deployed.
///
/// Precondition: at least one recording; cannot_be_joined says nothing. Threads: pure. Linear in the recordings.
/// Source: enabling and firing, paper, sec. II.
[[nodiscard]] Legality check_legal(std::span<const Recording> recordings, const net::Net& net,
                                   const ProcessMap& processes = {});

}  // namespace tessera::replay
