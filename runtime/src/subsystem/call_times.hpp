// How long transition functions take in simulated time, and how long behaviours last.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

#include "tessera/tables.hpp"

namespace tessera {

/// Draws the times of the calls of one subsystem: uniformly between the shortest and the longest one, or from the
/// distribution of the behaviour. They depend on the seed of the run and on the path of the subsystem only, so that no
/// order of turns changes them. Each call takes one number of the generator, so that a change of one distribution
/// leaves the times of other behaviours as they are.
class CallTimes {
 public:
  CallTimes() = default;
  CallTimes(std::uint64_t seed, std::string_view path) : state_(seed) {
    // FNV-1a
    for (const char letter : path) state_ = (state_ ^ static_cast<unsigned char>(letter)) * 1099511628211U;
  }

  [[nodiscard]] Duration draw(const Behaviour& behaviour) {
    if (behaviour.at_most <= behaviour.takes) return behaviour.takes;
    if (!behaviour.times.empty()) return at(behaviour.times, static_cast<std::uint32_t>(next() >> 32));
    const auto width = static_cast<std::uint64_t>((behaviour.at_most - behaviour.takes).count()) + 1;
    return behaviour.takes + Duration(static_cast<Duration::rep>(next() % width));
  }

 private:
  /// Inversion of the cumulative distribution. share: of 2^32.
  [[nodiscard]] static Duration at(std::span<const TimePoint> points, std::uint32_t share) {
    const auto after = std::ranges::upper_bound(points, share, {}, &TimePoint::below);
    if (after == points.end()) return points.back().time;
    const TimePoint &from = *std::prev(after), &to = *after;
    const double part = static_cast<double>(share - from.below) / static_cast<double>(to.below - from.below);
    return from.time + Duration(std::llround(static_cast<double>((to.time - from.time).count()) * part));
  }

  /// Source: Steele, Lea, Flood, OOPSLA 2014 (SplitMix64): a state of eight bytes, for fleets.
  std::uint64_t next() {
    std::uint64_t mixed = state_ += 0x9e3779b97f4a7c15U;
    mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebU;
    return mixed ^ (mixed >> 31);
  }

  std::uint64_t state_ = 0;
};

/// How long each behaviour has been the present one: from its first call until the first call of another one, or the
/// end of the subsystem.
class PresentTimes {
 public:
  /// Measures only subsystems of which a behaviour uses something. Allocates here alone.
  explicit PresentTimes(std::span<const Behaviour> behaviours) {
    if (std::ranges::any_of(behaviours, [](const Behaviour& one) { return !one.uses.empty(); }))
      times_.resize(behaviours.size());
  }

  void begin(std::uint16_t behaviour, Time now) {
    if (times_.empty() || behaviour == present_) return;
    end(now);
    present_ = behaviour;
    since_ = now;
  }
  void end(Time now) {
    if (present_ == nobody) return;
    times_[present_] += now - since_;
    present_ = nobody;
  }
  /// Until now. Empty: nothing is used.
  [[nodiscard]] std::vector<Duration> until(Time now) const {
    std::vector<Duration> times = times_;
    if (present_ != nobody) times[present_] += now - since_;
    return times;
  }

 private:
  std::vector<Duration> times_;  // per behaviour
  std::uint16_t present_ = nobody;
  Time since_{};
};

}  // namespace tessera
