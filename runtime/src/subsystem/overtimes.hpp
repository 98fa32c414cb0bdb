#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "system/processor_clocks.hpp"
#include "tessera/tables.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// The processor of a subsystem, if others share it.
struct SharedProcessor {
  std::shared_ptr<ProcessorClocks> clocks{};  ///< nullptr: it has one of its own
  std::size_t thread = 0;
  bool yields =
      false;  ///< another one has its priority, or a higher one: then a thread that is late may be in order
};

/// Compares the calls of a subsystem with the `takes` of its behaviours, and the wake-ups of its thread with `latency`:
/// the assumptions of the bounds of ages. On a shared processor, the time in which the others ran is left out.
///
/// Threads: the subsystem's. Allocates nothing after it was made.
class Overtimes {
 public:
  struct OfBehaviour {
    Duration declared{0};  ///< zero: nothing is declared
    std::uint64_t calls = 0, slow = 0;
    Duration longest{0};
    Time longest_at{};
  };
  /// A case of overtime, and the how manieth one it is.
  struct Finding {
    Duration took{0}, allowed{0};
    std::uint64_t number = 0;
  };

  Overtimes(const Instance& instance, Duration latency, SharedProcessor processor);

  /// Whether some behaviour declares `takes`.
  [[nodiscard]] bool judge_calls() const { return judge_calls_; }
  [[nodiscard]] bool fail() const { return fail_; }
  void enter_thread() {
    if (processor_.clocks != nullptr) processor_.clocks->enter(processor_.thread);
  }

  void begin_call(Time now);
  /// The call so far, if it is already longer than declared.
  [[nodiscard]] std::optional<Finding> over(std::uint16_t behaviour, Time now) const;
  /// Counts the call.
  [[nodiscard]] std::optional<Finding> end_call(std::uint16_t behaviour, Time now);
  /// The thread has gone on so long after it might.
  [[nodiscard]] std::optional<Finding> wake_up(Duration late);
  /// The latest wake-up since this was asked before, if it was later than allowed.
  [[nodiscard]] std::optional<Finding> take_late();

  /// Per behaviour of the net.
  [[nodiscard]] const std::vector<OfBehaviour>& behaviours() const { return behaviours_; }
  [[nodiscard]] std::uint64_t slow_calls() const { return slow_calls_; }
  [[nodiscard]] std::uint64_t late_wakeups() const { return late_wakeups_; }
  [[nodiscard]] Duration latest_wakeup() const { return latest_wakeup_; }

  /// Whether the case of that number is told: the 1st, 10th, 100th and so on.
  [[nodiscard]] static bool is_told(std::uint64_t number);

 private:
  [[nodiscard]] Duration length(Time now) const;

  std::vector<OfBehaviour> behaviours_;
  Duration latency_;
  SharedProcessor processor_;
  bool fail_, judge_calls_ = false;
  Time called_at_{};
  Duration others_{0};  // ran before the call
  Duration late_{0};
  std::uint64_t slow_calls_ = 0, late_wakeups_ = 0;
  Duration latest_wakeup_{0};
};

inline Overtimes::Overtimes(const Instance& instance, Duration latency, SharedProcessor processor)
    : latency_(latency),
      processor_(std::move(processor)),
      fail_(instance.policies.overtime == Overtime::fault) {
  for (const Behaviour& behaviour : instance.net->behaviours) {
    behaviours_.push_back({.declared = std::max(behaviour.takes, behaviour.at_most)});
    judge_calls_ = judge_calls_ || behaviours_.back().declared > Duration::zero();
  }
}

inline void Overtimes::begin_call(Time now) {
  called_at_ = now;
  if (processor_.clocks != nullptr && judge_calls_)
    others_ = processor_.clocks->used_by_others(processor_.thread);
}

inline Duration Overtimes::length(Time now) const {
  const Duration lasted = now - called_at_;
  if (processor_.clocks == nullptr) return lasted;
  const Duration others = processor_.clocks->used_by_others(processor_.thread) - others_;
  return lasted - std::clamp(others, Duration::zero(), lasted);
}

inline std::optional<Overtimes::Finding> Overtimes::over(std::uint16_t behaviour, Time now) const {
  const OfBehaviour& one = behaviours_[behaviour];
  if (one.declared == Duration::zero()) return std::nullopt;
  const Duration took = length(now);
  if (took <= one.declared) return std::nullopt;
  return Finding{took, one.declared, one.slow + 1};
}

inline std::optional<Overtimes::Finding> Overtimes::end_call(std::uint16_t behaviour, Time now) {
  OfBehaviour& one = behaviours_[behaviour];
  if (one.declared == Duration::zero()) return std::nullopt;
  ++one.calls;
  const Duration took = length(now);
  if (took > one.longest) {
    one.longest = took;
    one.longest_at = called_at_;
  }
  if (took <= one.declared) return std::nullopt;
  ++slow_calls_;
  return Finding{took, one.declared, ++one.slow};
}

inline std::optional<Overtimes::Finding> Overtimes::wake_up(Duration late) {
  if (processor_.yields) return std::nullopt;
  latest_wakeup_ = std::max(latest_wakeup_, late);
  if (latency_ == Duration::zero() || late <= latency_) return std::nullopt;
  late_ = std::max(late_, late);
  return Finding{late, latency_, ++late_wakeups_};
}

inline std::optional<Overtimes::Finding> Overtimes::take_late() {
  const Duration late = std::exchange(late_, Duration::zero());
  if (late == Duration::zero()) return std::nullopt;
  return Finding{late, latency_, late_wakeups_};
}

inline bool Overtimes::is_told(std::uint64_t number) {
  while (number >= 10 && number % 10 == 0) number /= 10;
  return number == 1;
}

}  // namespace tessera
