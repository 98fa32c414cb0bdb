// The runs that a system can make, one at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "timing/worst/run_log.hpp"

namespace tessera::timing {

/// Plays runs of a system by the rules of the runtime: releases on the grid, transfers through channels with one slot,
/// timeouts after all else, turns that last until a subsystem has to wait. Shared processors have fixed priorities,
/// and equals come in the order in which they wake up.
///
/// Threads: one.
class PlayedRun {
 public:
  /// chain: nothing is logged but the values of its channels, the calls, and its commands.
  PlayedRun(const System& system, const Chain& chain);

  /// Valid until the next call.
  const RunLog& play(const RunPlan& plan, Time until);
  /// The work of all runs so far, the same on every machine.
  [[nodiscard]] std::uint64_t steps() const { return steps_; }

 private:
  enum class At : std::uint8_t { released, calling, sending, receiving };
  struct Transfer {
    std::uint32_t channel = 0;
    Time since = -1;  ///< -1: it has not begun
    bool done = false;
  };
  struct State {
    At at = At::released;
    bool asleep = false;
    Time wakes = unbounded;  ///< asleep: when it may go on
    Time queued = 0;         ///< when it last woke up
    Time due = 0;            ///< the release; of a call on a processor of its own, the end
    Time left = 0;           ///< of a call on a shared processor
    Time next_release = -1;  ///< its number; -1: before the first one
    Time waited = 0, blocked_since = -1;
    std::vector<Transfer> transfers;
  };
  struct Slot {
    bool full = false, acked = false;
    std::int64_t write = -1;  ///< of the channel's hop, the last one
  };
  struct Hop {
    std::uint32_t channel = 0, from = 0, to = 0;
    std::int64_t held = -1;  ///< the read that the receiver has made last
  };

  [[nodiscard]] const Subsystem& of(std::uint32_t i) const { return system_.subsystems[i]; }
  [[nodiscard]] PlannedCall planned(std::uint32_t i) const;
  [[nodiscard]] Time latency_of(std::uint32_t i) const { return planned(i).late ? system_.latency : 0; }
  [[nodiscard]] bool shares(std::uint32_t i) const { return of(i).processor >= 0; }
  [[nodiscard]] bool is_able(std::uint32_t i) const;
  [[nodiscard]] bool gets_processor(std::uint32_t i) const;
  /// It has its processor, and uses it.
  [[nodiscard]] bool is_running(std::uint32_t i) const;
  [[nodiscard]] std::int64_t next_turn() const;
  [[nodiscard]] Time next_instant() const;
  void advance(Time to);

  void wake_up(std::uint32_t i);
  void turn(std::uint32_t i);
  [[nodiscard]] bool step(std::uint32_t i);
  void arrive(std::uint32_t i);
  void begin_call(std::uint32_t i);
  void end_call(std::uint32_t i);
  void begin_transfers(std::uint32_t i, At at);
  [[nodiscard]] bool transfer(std::uint32_t i);
  [[nodiscard]] bool send(Transfer& transfer);
  [[nodiscard]] bool receive(Transfer& transfer);
  void notify(std::uint32_t i, At at, std::uint32_t channel);
  void log_write(std::uint32_t channel);
  void log_read(std::uint32_t channel);

  const System& system_;
  const Chain& chain_;
  const RunPlan* plan_ = nullptr;
  Time now_ = 0;
  std::vector<State> states_;
  std::vector<Slot> slots_;
  std::vector<Hop> hops_;
  std::vector<std::vector<std::uint32_t>> hops_of_channel_,
      hops_to_;                                    ///< hops over a channel, to a subsystem
  std::vector<std::vector<std::uint32_t>> mates_;  ///< per subsystem, the others on its processor
  std::vector<std::uint32_t> running_;             ///< scratch of `advance`
  RunLog log_;
  std::uint64_t steps_ = 0;
};

}  // namespace tessera::timing
