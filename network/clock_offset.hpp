#pragma once

#include <chrono>
#include <optional>

namespace tessera::network {

/// How far the clock of another process is ahead of the clock of this one: between `ahead - uncertainty` and
/// `ahead + uncertainty`, if no clock was set meanwhile.
struct ClockOffset {
  std::chrono::nanoseconds ahead{0}, uncertainty{0};
};

/// Estimates a clock offset from messages that carry the time of their sender, and from the round-trip time
/// of a message and its answer. It keeps the best of all samples: the shorter the way, the more exact.
///
/// Threads: one at a time. No member allocates or throws.
class ClockOffsetEstimate {
 public:
  using Duration = std::chrono::nanoseconds;
  /// The largest drift between two clocks in a second per second; usual computers drift less.
  static constexpr double drift = 1e-4;

  /// A message has come.
  ///
  /// difference:  the time of its sender when it was sent, minus the time here now.
  /// longest_way: upper bound of the time that the message travelled.
  /// now:         by any monotonic clock.
  void add(Duration difference, Duration longest_way, Duration now);
  /// nullopt: there is no sample yet.
  [[nodiscard]] std::optional<ClockOffset> at(Duration now) const;

 private:
  struct Sample {
    ClockOffset offset;
    Duration taken;
  };
  std::optional<Sample> best_;
};

}  // namespace tessera::network
