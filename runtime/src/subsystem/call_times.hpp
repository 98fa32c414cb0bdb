// How long transition functions take in simulated time.
#pragma once

#include <cstdint>
#include <string_view>

#include "tessera/tables.hpp"

namespace tessera {

/// Draws the times of the calls of one subsystem, uniformly between the shortest and the longest one. They depend on the
/// seed of the run and on the path of the subsystem only, so that no order of turns changes them.
class CallTimes {
 public:
  CallTimes() = default;
  CallTimes(std::uint64_t seed, std::string_view path) : state_(seed) {
    // FNV-1a
    for (const char letter : path) state_ = (state_ ^ static_cast<unsigned char>(letter)) * 1099511628211U;
  }

  [[nodiscard]] Duration draw(const Behaviour& behaviour) {
    if (behaviour.at_most <= behaviour.takes) return behaviour.takes;
    const auto width = static_cast<std::uint64_t>((behaviour.at_most - behaviour.takes).count()) + 1;
    return behaviour.takes + Duration(static_cast<Duration::rep>(next() % width));
  }

 private:
  /// Source: Steele, Lea, Flood, OOPSLA 2014 (SplitMix64): a state of eight bytes, for fleets.
  std::uint64_t next() {
    std::uint64_t mixed = state_ += 0x9e3779b97f4a7c15U;
    mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebU;
    return mixed ^ (mixed >> 31);
  }

  std::uint64_t state_ = 0;
};

}  // namespace tessera
