#include "watch/watchdogs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>
#include <utility>

namespace tessera {
namespace {

// The supervisor wakes at least and at most so often for calls that are longer than declared.
constexpr Duration soonest_judgement = std::chrono::milliseconds(10),
                   latest_judgement = std::chrono::seconds(1);

}  // namespace

Watchdogs::Watchdogs(const std::vector<std::unique_ptr<SubsystemExecutor>>& executors,
                     std::function<void(std::uint32_t)> secure, RecordingLane* lane)
    : secure_(std::move(secure)), lane_(lane) {
  for (std::uint32_t instance = 0; instance < executors.size(); ++instance)
    if (const Duration limit = executors[instance]->operations().parts().instance->policies.watchdog;
        limit > Duration::zero())
      watched_.push_back({executors[instance].get(), instance, limit});
  for (const auto& executor : executors) {
    const SubsystemParts& parts = executor->operations().parts();
    if (!executor->operations().overtimes().judge_calls() || parts.processor.clocks != nullptr) continue;
    const Duration period = parts.instance->period;
    const Duration every = period > Duration::zero()
                               ? std::clamp(period / 2, soonest_judgement, latest_judgement)
                               : latest_judgement;
    declared_.push_back({executor.get(), every});
    between_looks_ = declared_.size() == 1 ? every : std::min(between_looks_, every);
  }
}

/// Tells it once per call, of the 1st, 10th, 100th such call.
void Watchdogs::look(Declared& one, Time now) const {
  const Gauges& gauges = one.executor->gauges();
  const std::int64_t since_ns = gauges.called_at_ns.load(std::memory_order_acquire);
  if (since_ns == one.told_ns || !gauges.calling.load(std::memory_order_acquire)) return;
  const std::uint16_t behaviour = gauges.behaviour.load(std::memory_order_relaxed);
  const Operations& operations = one.executor->operations();
  const Duration lasts = now - Time(Duration(since_ns)),
                 allowed = operations.overtimes().behaviours()[behaviour].declared;
  // The behaviour is that of this call, if it still runs.
  if (allowed == Duration::zero() || lasts <= allowed ||
      gauges.called_at_ns.load(std::memory_order_acquire) != since_ns)
    return;
  one.told_ns = since_ns;
  if (!Overtimes::is_told(++one.number)) return;
  const SubsystemNet& net = *operations.parts().instance->net;
  const auto place = std::ranges::find_if(net.places, [&](const Place& place) {
    return place.does.kind == Does::Kind::call && place.does.subject == behaviour;
  });
  std::array<char, 192> text;
  const auto end = fmt::format_to_n(text.data(), text.size(),
                                    "has not returned for {:.6g} ms, longer than its takes of {:.6g} ms",
                                    seconds(lasts) * 1e3, seconds(allowed) * 1e3);
  operations.reports().tell(Fault::overtime,
                            place == net.places.end() ? net.behaviours[behaviour].name : place->name,
                            {text.data(), std::min(end.size, text.size())}, lane_);
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
  if (declared_.empty()) return next;
  if (now >= next_look_) {
    for (Declared& one : declared_) look(one, now);
    next_look_ = now + between_looks_;
  }
  return std::min(next, next_look_);
}

}  // namespace tessera
