// Subsystems whose instants are known, so that chains through them can be followed value by value.
#pragma once

#include <optional>
#include <vector>

#include "timing/occurrences.hpp"

namespace tessera::timing {

/// The instants of those that begin an iteration at every instant of their grid, or are driven by the values of such
/// a subsystem: their only wait is for them.
///
/// Iterations have numbers; those of a driven subsystem are numbers of the values that drive it. Before the device
/// reading of its first driver, some of its iterations use none: they have negative numbers.
/// Source: Becker et al., J. Systems Architecture 80, 2017, for the enumeration of job chains.
class Clocked {
 public:
  explicit Clocked(const Occurrences& bounds);

  [[nodiscard]] bool knows(std::uint32_t subsystem) const { return all_[subsystem].known; }
  /// The channel whose values drive it; none: its own rate.
  [[nodiscard]] std::optional<std::uint32_t> driver(std::uint32_t subsystem) const {
    return all_[subsystem].driver;
  }
  /// After that time everything repeats.
  [[nodiscard]] Time pattern(std::uint32_t subsystem) const { return all_[subsystem].pattern; }
  /// Its iterations in that time.
  [[nodiscard]] Time repeat(std::uint32_t subsystem) const { return all_[subsystem].repeat; }
  /// From then on.
  [[nodiscard]] Time settled(std::uint32_t subsystem) const { return all_[subsystem].settled; }
  /// Iterations before the one with number 0.
  [[nodiscard]] Time before(std::uint32_t subsystem) const { return all_[subsystem].before; }
  /// Numbers that were computed.
  [[nodiscard]] Time numbers(std::uint32_t subsystem) const;
  /// When that write, or end of the call, occurs in the iteration of that number.
  [[nodiscard]] Time latest(EventId y, Time number) const;
  [[nodiscard]] Time earliest(EventId y, Time number) const;
  /// Most time between two of its iterations.
  [[nodiscard]] Time gap(std::uint32_t subsystem) const;
  /// As Occurrences::staleness, where the values of the channel drive its receiver; else unbounded.
  [[nodiscard]] Time staleness(std::uint32_t channel) const;

  static constexpr Time most_iterations = 20'000;

 private:
  struct One {
    bool known = false;
    std::optional<std::uint32_t> driver{};
    Time pattern = 0, settled = 0;
    Time repeat = 1;  ///< iterations in a pattern
    Time before = 0;
    /// Driven, per value: the latest and the earliest start of the iteration that uses it or a newer one, and when it
    /// has been received at the latest.
    std::vector<Time> start{}, earliest{}, read{};
  };

  [[nodiscard]] std::optional<std::uint32_t> driver_of(std::uint32_t subsystem) const;
  bool drive(std::uint32_t subsystem);
  [[nodiscard]] Time call_time(std::uint32_t subsystem) const;

  const Occurrences& bounds_;
  std::vector<One> all_;
};

}  // namespace tessera::timing
