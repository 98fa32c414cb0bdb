#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "assembly/assembly.hpp"

namespace tessera {

/// Subsystems that can never fire again, whatever time passes and whatever functions compute. Such a
/// subsystem has only transitions that lack tokens of a channel. For each of these transitions, the
/// subsystem at the other end has ended, is stuck itself, or has left all behaviours that give such tokens.
/// Subsystems that run, or wait for their rate or for a timeout, are not stuck.
///
/// Sound: it names no subsystem that could go on. Not complete: conditions and functions may keep a peer
///        from a behaviour that it could enter by the net.
///
/// Threads: only while no subsystem runs. Linear in the net for each round in which a
///          subsystem is found not stuck.
[[nodiscard]] std::vector<std::uint32_t> stuck_for_good(const Assembly& assembly);

/// The same while threads run. It considers only the subsystems that rest until another wakes them, so it
/// finds only those that wait for others that rest or have ended. resting: each has rested in the same
/// sleep since before the call. The answer holds if each still rests in that sleep after the call.
[[nodiscard]] std::vector<std::uint32_t> stuck_among_resting(const Assembly& assembly,
                                                             const std::vector<bool>& resting);

/// "stuck for good: robot.arm at hold.rcv.goal.in waits for robot.control over 'goal', which has ended
/// (since 1.250 s); ...". Precondition: `stuck` is the result of one of the functions above.
[[nodiscard]] std::string stuck_text(const Assembly& assembly, const std::vector<std::uint32_t>& stuck);

/// Checks from time to time whether a subsystem is stuck for good, reports it once, and gives its
/// devices their safe command.
///
/// Threads: one.
class StuckWatch {
 public:
  explicit StuckWatch(std::uint32_t instances) : said_(instances) {}

  /// Under the simulated clock, while no subsystem runs. Checks only if a subsystem has
  /// waited for long, and rarely.
  void look(Assembly& assembly, Time now);
  /// In real time: `stuck` was found while threads run. secure: gives the devices of a
  /// subsystem their safe command.
  void found(Assembly& assembly, const std::vector<std::uint32_t>& stuck, Time now,
             const std::function<void(std::uint32_t)>& secure);

 private:
  std::vector<bool> said_;  // per instance
  Time next_ = Time{} + std::chrono::seconds(1);
};

}  // namespace tessera
