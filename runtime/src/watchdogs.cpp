#include "watchdogs.hpp"

#include <algorithm>

namespace tessera {

Watchdogs::Watchdogs(const std::vector<std::unique_ptr<SubsystemExecutor>>& executors, RecordingLane* lane)
    : lane_(lane) {
  for (const auto& executor : executors)
    if (const Duration limit = executor->operations().parts().instance->policies.watchdog;
        limit > Duration::zero())
      watched_.push_back({executor.get(), limit});
}

Time Watchdogs::check(Time now) {
  Time next = Time::max();
  for (Watched& one : watched_) {
    const Gauges& gauges = one.executor->gauges();
    Time due = now + one.limit;  // a call that begins from now on
    const std::int64_t since_ns = gauges.called_at_ns.load(std::memory_order_acquire);
    if (since_ns != one.alarmed_ns && gauges.calling.load(std::memory_order_acquire)) {
      due = Time(Duration(since_ns)) + one.limit + Duration(1);
      if (due <= now) {
        one.alarmed_ns = since_ns;
        one.executor->raise_alarm(since_ns, lane_);
        due = now + one.limit;
      }
    }
    next = std::min(next, due);
  }
  return next;
}

}  // namespace tessera
