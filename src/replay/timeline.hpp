#pragma once

#include <string>
#include <vector>

#include "tessera/recording.hpp"

namespace tessera::replay {

/// The behaviours of a subsystem over time.
struct Lane {
  struct Stretch {
    std::size_t behaviour;  ///< index into `behaviours`
    double from_s, to_s;
  };
  std::string path;                     ///< of the subsystem
  std::vector<std::string> behaviours;  ///< in order of first appearance
  std::vector<Stretch> stretches;
  std::vector<double> errors_s;  ///< times at which an iteration ended in an error
  std::uint64_t iterations = 0;
};

struct Timeline {
  double end_s = 0;  ///< time of the last event
  std::vector<Lane> lanes;
};

/// Reads the firings by their roles: `start` enters a subsystem's first behaviour, `leave` leaves a behaviour,
/// `begin_sending` (its function has been calculated) is an iteration of it and `error` (t6) an error.
[[nodiscard]] Timeline timeline_of(const Recording& recording);

/// At most `columns` stretches: each column of time shows the behaviour that ran longest in it.
[[nodiscard]] std::vector<Lane::Stretch> thinned(const Lane& lane, double end_s, std::size_t columns);

}  // namespace tessera::replay
