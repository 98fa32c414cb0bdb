// How a subsystem calls its transition functions: when, and the reaction if one does not return in time.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "subsystem/subsystem_executor.hpp"

namespace tessera {

/// The start of the iteration for a token that has just arrived.
Time SubsystemExecutor::release() {
  const Duration waited = std::exchange(waited_, Duration::zero());
  ++releases_made_;
  const ForcedCall* const forced = forced_call();
  const Duration late = forced == nullptr ? Duration::zero() : forced->late;
  if (!releases_.have_rate()) return late == Duration::zero() ? Time::min() : now() + late;
  renew_time();
  const Releases::Release release = releases_.next(now_, waited);
  if (release.overruns > 0 && lane_ != nullptr)
    lane_->overrun(now_, static_cast<std::uint32_t>(std::min<std::uint64_t>(release.overruns, UINT32_MAX)));
  return release.at + late;
}

/// Begins or ends a transition function; false: it has to wait.
bool SubsystemExecutor::advance(std::uint32_t place) {
  Token& token = tokens_[place];
  const Duration watchdog = operations_.parts().instance->policies.watchdog;
  if (places_[place].does == Does::Kind::begin) {
    gauges_.behaviour.store(plan_->places[place].subject, std::memory_order_relaxed);
    token.phase = Phase::finished;
    return true;
  }
  if (token.phase == Phase::released_later) {
    // User code may take long: a wait that is over must not hold back another subsystem meanwhile.
    if (registrations_ > 0 && !register_waits()) return true;
    const std::uint16_t behaviour = plan_->places[place].subject;
    const Time begin = now();
    gauges_.begin_call(behaviour, begin);
    operations_.start_call(behaviour, begin, releases_.take_missed());
    time_is_known_ = false;
    token.phase = Phase::running;
    token.due = Time::min();
    if (simulated_) {
      const ForcedCall* const forced = forced_call();
      token.due = begin + (forced == nullptr ? operations_.draw_time(behaviour) : forced->takes);
    }
    if (watchdog > Duration::zero() && token.due > begin + watchdog)
      returns_ = std::exchange(token.due, begin + watchdog + Duration(1));
    if (token.due > begin) return true;
  }
  if (returns_ != Time{}) {
    token.due = std::exchange(returns_, Time{});
    if (mark_alarm(gauges_.called_at_ns.load(std::memory_order_relaxed))) {
      effectors().make_safe({SafeReason::Kind::stalls}, Effectors::Busy::leaves_out);
      tell_alarm(lane_);
      effectors().record(lane_);
    }
    return true;
  }
  if (watched_ || !operations_.devices().none() || operations_.overtimes().fail()) renew_time();
  operations_.finish_call(now_);
  gauges_.end_call(now_);
  if (watchdog > Duration::zero()) end_alarm();
  show();
  token.phase = Phase::finished;
  return true;
}

void SubsystemExecutor::note_wakeup(Duration late) {
  if (marked_.empty()) return;
  operations_.note_wakeup(late, name_of(marked_.front()));
  const Overtimes& overtimes = operations_.overtimes();
  gauges_.late_wakeups.store(overtimes.late_wakeups(), std::memory_order_relaxed);
  gauges_.latest_wakeup_ns.store(overtimes.latest_wakeup().count(), std::memory_order_relaxed);
}

bool SubsystemExecutor::mark_alarm(std::int64_t since_ns) {
  control_.mark_stalled(index_, true);
  // Either this sees that the call is over, or the subsystem's thread sees the mark: mark_stalled, the end of
  // the call and both looks are sequentially consistent.
  if (!gauges_.calling.load(std::memory_order_seq_cst) ||
      gauges_.called_at_ns.load(std::memory_order_relaxed) != since_ns) {
    control_.mark_stalled(index_, false);
    return false;
  }
  wake_receivers();
  return true;
}

void SubsystemExecutor::tell_alarm(RecordingLane* lane) const {
  operations_.report_stall(gauges_.behaviour.load(std::memory_order_relaxed), lane);
}

void SubsystemExecutor::end_alarm() {
  gauges_.calling.store(false, std::memory_order_seq_cst);
  if (!control_.is_stalled(index_)) return;
  control_.mark_stalled(index_, false);
  wake_receivers();
}

/// Called once an iteration, for observers.
void SubsystemExecutor::show() {
  gauges_.iterations.store(operations_.iterations(), std::memory_order_relaxed);
  gauges_.errors.store(operations_.errors(), std::memory_order_relaxed);
  gauges_.firings.store(firings_, std::memory_order_relaxed);
  gauges_.overruns.store(overruns(), std::memory_order_relaxed);
  gauges_.slow_calls.store(operations_.overtimes().slow_calls(), std::memory_order_relaxed);
  if (memory_ != nullptr) memory_->show();
}

// -------------------------------------------------------------------------------------------- overtime

namespace {

/// The beginning of a message, in its room.
class OvertimeText {
 public:
  OvertimeText(bool of_call, const Overtimes::Finding& found) {
    const double took_ms = seconds(found.took) * 1e3, allowed_ms = seconds(found.allowed) * 1e3;
    if (of_call)
      put("took {:.6g} ms, longer than its takes of {:.6g} ms", took_ms, allowed_ms);
    else
      put("its thread went on {:.6g} ms late, and latency is {:.6g} ms", took_ms, allowed_ms);
  }
  [[nodiscard]] std::string_view numbered(std::uint64_t number) {
    if (number > 1) put("; it is the {}th time", number);
    return get();
  }
  [[nodiscard]] std::string_view get() const { return {room_.data(), size_}; }

 private:
  template <class... Values>
  void put(fmt::format_string<const Values&...> text, const Values&... values) {
    const std::size_t left = room_.size() - size_;
    size_ += std::min(left, fmt::format_to_n(room_.data() + size_, left, text, values...).size);
  }
  std::array<char, 192> room_;
  std::size_t size_ = 0;
};

}  // namespace

/// With Overtime::fault the call fails.
void Operations::check_overtime(Time now) {
  if (failed_) return;
  const std::optional<Overtimes::Finding> slow = overtimes_.over(behaviour_, now);
  const std::optional<Overtimes::Finding> found = slow ? slow : overtimes_.take_late();
  if (found) fail(Fault::overtime, behaviour_, OvertimeText(slow.has_value(), *found).get());
}

/// Counts the call. Unless it has failed for it, overtime is told, and nothing else happens.
void Operations::tell_overtime(Time now) {
  const std::optional<Overtimes::Finding> found = overtimes_.end_call(behaviour_, now);
  if (!found || (overtimes_.fail() && failed_) || !Overtimes::is_told(found->number)) return;
  reports_.tell(Fault::overtime, place_of_call(behaviour_),
                OvertimeText(true, *found).numbered(found->number), lane_);
}

void Operations::note_wakeup(Duration late, std::string_view place) {
  const std::optional<Overtimes::Finding> found = overtimes_.wake_up(late);
  if (!found || !Overtimes::is_told(found->number)) return;
  reports_.tell(Fault::overtime, place, OvertimeText(false, *found).numbered(found->number), lane_);
}

}  // namespace tessera
