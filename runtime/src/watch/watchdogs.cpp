#include "watch/watchdogs.hpp"

#include <algorithm>
#include <utility>

namespace tessera {

Watchdogs::Watchdogs(const std::vector<std::unique_ptr<SubsystemExecutor>>& executors,
                     std::function<void(std::uint32_t)> secure, RecordingLane* lane)
    : secure_(std::move(secure)), lane_(lane) {
  for (std::uint32_t instance = 0; instance < executors.size(); ++instance)
    if (const Duration limit = executors[instance]->operations().parts().instance->policies.watchdog;
        limit > Duration::zero())
      watched_.push_back({executors[instance].get(), instance, limit});
}

Time Watchdogs::check(Time now) {
  Time next = Time::max();
  for (Watched& one : watched_) {
    const Gauges& gauges = one.executor->gauges();
    Time due = now + one.limit;  // for a call that begins from now on
    const std::int64_t since_ns = gauges.called_at_ns.load(std::memory_order_acquire);
    if (since_ns != one.alarmed_ns && gauges.calling.load(std::memory_order_acquire)) {
      due = Time(Duration(since_ns)) + one.limit + Duration(1);
      if (due <= now) {
        one.alarmed_ns = since_ns;
        if (one.executor->mark_alarm(since_ns)) {
          secure_(one.instance);
          one.executor->tell_alarm(lane_);
        }
        due = now + one.limit;
      }
    }
    next = std::min(next, due);
  }
  return next;
}

}  // namespace tessera
