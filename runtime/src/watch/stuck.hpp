#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "assembly/assembly.hpp"

namespace tessera {

/// Which subsystems can never fire again, whatever time passes and whatever functions compute: each has
/// transitions that lack tokens of a channel, and no other kind, and for each of them the subsystem at the
/// other end has ended, is stuck itself, or has left all behaviours that give such tokens. Subsystems that
/// run, wait for their rate or for a timeout are none of them.
///
/// Sound: nobody is named who could go on. Not complete: conditions and functions may keep a peer from a
/// behaviour that it could enter by the net.
///
/// Threads: when no subsystem runs. Linear in the net for each round in which somebody is cleared.
[[nodiscard]] std::vector<std::uint32_t> stuck_for_good(const Assembly& assembly);

/// The same from outside, while threads run, of those that rest until another wakes them: only those are
/// found who wait for others that rest, or have ended. resting: each has rested in the same sleep since
/// before the call; the answer holds if it still has after.
[[nodiscard]] std::vector<std::uint32_t> stuck_among_resting(const Assembly& assembly,
                                                             const std::vector<bool>& resting);

/// "stuck for good: robot.arm at hold.rcv.goal.in waits for robot.control over 'goal', which has ended (since
/// 1.250 s); ..." Precondition: `stuck` is what one of the functions above has found.
[[nodiscard]] std::string stuck_text(const Assembly& assembly, const std::vector<std::uint32_t>& stuck);

/// Looks now and then whether somebody is stuck for good, says so once, and gives the devices of those their
/// safe command.
///
/// Threads: one.
class StuckWatch {
 public:
  explicit StuckWatch(std::uint32_t instances) : said_(instances) {}

  /// Under the simulated clock, where nobody runs at the moment. Looks only if somebody has waited for long,
  /// and seldom.
  void look(Assembly& assembly, Time now);
  /// In real time: `stuck` has been found from outside. secure: gives the devices of a subsystem their safe
  /// command.
  void found(Assembly& assembly, const std::vector<std::uint32_t>& stuck, Time now,
             const std::function<void(std::uint32_t)>& secure);

 private:
  std::vector<bool> said_;  // per instance
  Time next_ = Time{} + std::chrono::seconds(1);
};

}  // namespace tessera
