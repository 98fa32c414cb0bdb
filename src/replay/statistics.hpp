#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tessera/recording.hpp"

namespace tessera::replay {

/// The distribution of a duration, in seconds. Quantiles are by nearest rank.
struct Distribution {
  std::uint64_t count = 0;
  double least = 0, mean = 0, median = 0, p99 = 0, most = 0;
  /// Numbers of durations in equal steps from least to most; empty if all are equal.
  std::vector<std::uint64_t> histogram;
};

struct SubsystemStatistics {
  std::string path;
  std::uint64_t firings = 0, iterations = 0, errors = 0;
  std::uint64_t overruns = 0;  ///< instants of its rate missed because of its own work
  std::uint64_t faults = 0;    ///< of any kind
  Distribution period;         ///< from one end of a transition function (t1) to the next
  Distribution call;           ///< from the beginning of a transition function to t1; empty without values
  Distribution iteration;      ///< from t1 to t4, t5 or t6: the time of communication
  struct Wait {
    std::string channel;  ///< path of the block's transition without the path of the subsystem
    Distribution time;    ///< since the subsystem's previous firing
  };
  std::vector<Wait> waits;       ///< those of communication transitions, the longest mean first
  std::uint64_t timeouts = 0;    ///< firings of Step::timeout
  std::uint64_t skips = 0;       ///< firings of Step::skip
  std::uint64_t overwrites = 0;  ///< firings of Step::overwrite
};

/// The statistics of each subsystem. Linear in the recording (quantiles: linear on average).
[[nodiscard]] std::vector<SubsystemStatistics> statistics_of(const Recording& recording);

}  // namespace tessera::replay
