#include "subsystem/releases.hpp"

#include <algorithm>

namespace tessera {

Releases::Release Releases::next(Time arrival, Duration waited) {
  std::uint64_t overruns = 0;
  if (!next_) {
    next_ = arrival.time_since_epoch() / period_;  // the first call starts at once
  } else {
    const std::int64_t now = first_not_before(arrival), without_waiting = first_not_before(arrival - waited);
    overruns = count_overruns(without_waiting);
    const std::int64_t to_make_up =
        overrun_ == Overrun::catch_up ? std::max<std::int64_t>(0, without_waiting - *next_) : 0;
    next_ = std::max(*next_, now - to_make_up);
  }
  return {Time(period_ * (*next_)++), overruns};
}

/// Instants before `end` that no call has been made for.
std::uint64_t Releases::count_overruns(std::int64_t end) {
  const std::int64_t passed_over = end - std::max(*next_, counted_to_);
  if (passed_over <= 0) return 0;
  counted_to_ = end;
  const auto count = static_cast<std::uint64_t>(passed_over);
  overruns_ += count;
  if (overrun_ == Overrun::fault) missed_ = count;
  return count;
}

}  // namespace tessera
