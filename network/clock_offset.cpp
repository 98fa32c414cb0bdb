#include "network/clock_offset.hpp"

namespace tessera::network {

void ClockOffsetEstimate::add(Duration difference, Duration longest_way, Duration now) {
  const Sample sample{{difference + longest_way / 2, longest_way / 2}, now};
  const std::optional<ClockOffset> known = at(now);
  // If the two samples contradict each other, a clock was set: the new sample counts.
  const auto apart = [&] {
    const Duration between = sample.offset.ahead > known->ahead ? sample.offset.ahead - known->ahead
                                                                : known->ahead - sample.offset.ahead;
    return between > sample.offset.uncertainty + known->uncertainty;
  };
  if (!known || sample.offset.uncertainty <= known->uncertainty || apart()) best_ = sample;
}

std::optional<ClockOffset> ClockOffsetEstimate::at(Duration now) const {
  if (!best_) return std::nullopt;
  const double age_ns = static_cast<double>((now - best_->taken).count());
  return ClockOffset{best_->offset.ahead,
                     best_->offset.uncertainty + Duration(static_cast<Duration::rep>(age_ns * drift))};
}

}  // namespace tessera::network
