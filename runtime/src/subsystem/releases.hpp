#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "tessera/tables.hpp"
#include "tessera/time.hpp"

namespace tessera {

/// When the calls of a subsystem with a rate begin: at instants k * period, with at most one call for each
/// instant (SubsystemExecutor, *Release*).
///
/// Threads: the subsystem's.
class Releases {
 public:
  /// period: zero if there is no rate.
  Releases(Duration period, Overrun overrun) : period_(period), overrun_(overrun) {}

  [[nodiscard]] bool have_rate() const { return period_ > Duration::zero(); }
  struct Release {
    Time at{};
    std::uint64_t overruns = 0;  ///< instants passed over since they were last counted
  };
  /// The instant of the next call, whose token has arrived. waited: the time spent waiting for other
  /// subsystems since the last call.
  /// Precondition: there is a rate.
  [[nodiscard]] Release next(Time arrival, Duration waited);
  /// The number of missed instants for which the next call has to fail. Resets it.
  [[nodiscard]] std::uint64_t take_missed() { return std::exchange(missed_, 0); }
  [[nodiscard]] std::uint64_t overruns() const { return overruns_; }

 private:
  [[nodiscard]] std::int64_t first_not_before(Time time) const {
    return (time.time_since_epoch() + period_ - Duration(1)) / period_;
  }
  [[nodiscard]] std::uint64_t count_overruns(std::int64_t end);

  Duration period_;
  Overrun overrun_;
  std::optional<std::int64_t> next_;  // k of the next instant; nullopt: before the first call
  std::int64_t counted_to_ = 0;       // k up to which overruns have been counted
  std::uint64_t missed_ = 0;          // instants that the next call has to fail for
  std::uint64_t overruns_ = 0;
};

}  // namespace tessera
