#pragma once

#include <optional>
#include <span>
#include <string>

#include "net/net.hpp"
#include "replay/deployed_net.hpp"
#include "replay/legality.hpp"
#include "tessera/recording.hpp"

namespace tessera::replay {

/// Is it a recording of a deployed system, or of one of its processes? check_legal judges only others.
[[nodiscard]] bool is_of_deployed(const Recording& recording);

/// Why these recordings cannot be judged together: two of one process and incarnation, a process that the
/// system does not have, a simulated run beside others; nullopt: they can.
[[nodiscard]] std::optional<std::string> cannot_be_joined(std::span<const Recording> recordings,
                                                          const ProcessMap& processes);

/// Are these recordings one legal run of a deployed net? Either one recording of a simulated run of the whole
/// system, or any number of those of its processes; several of one process are its starts.
///
/// The firings of one subsystem are ordered, and so are those of one local channel. A value of a channel
/// between processes is written before it is read, and its read has ended before its sender fires that it
/// knows. Any order that keeps these is as good as another. Times of different recordings are not compared.
///
/// A simulated run in which processes die is judged as if each of their starts had a recording of its own.
///
/// incomplete: a recording is cut off, has lost events, or is not given. Then all that is given was checked as
/// far as possible. The marking is empty: nobody records what happens between the processes.
///
/// Precondition: cannot_be_joined says nothing. Threads: pure. Linear in the recordings.
[[nodiscard]] Legality check_joint(std::span<const Recording> recordings, const net::Net& net,
                                   const ProcessMap& processes);

}  // namespace tessera::replay
