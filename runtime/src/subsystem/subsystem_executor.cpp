#include "subsystem/subsystem_executor.hpp"

#include <algorithm>
#include <utility>

#include "system/thread_role.hpp"

namespace tessera {

SubsystemExecutor::SubsystemExecutor(std::uint32_t index, SubsystemParts parts,
                                     std::shared_ptr<const Plan> plan, std::uint32_t first_transition,
                                     Shared shared, RecordingLane* lane)
    : index_(index),
      operations_(std::move(parts), shared.control, shared.clock, lane),
      releases_(operations_.parts().instance->period, operations_.parts().instance->policies.overrun),
      plan_(std::move(plan)),
      first_transition_(first_transition),
      control_(shared.control),
      clock_(shared.clock),
      waker_(shared.waker),
      lane_(lane),
      watched_(shared.watched || operations_.parts().instance->policies.watchdog > Duration::zero()),
      simulated_(shared.clock.simulated()),
      ports_(operations_.parts().ports.data()),
      places_(plan_->places.data()),
      tokens_(plan_->places.size()),
      wants_(plan_->ports.size()),
      wants_next_(plan_->ports.size()) {
  marked_.reserve(plan_->places.size());
  if (const Bindings& bindings = operations_.parts().bindings; shared.watched && !bindings.memory.empty())
    memory_ = std::make_unique<MemoryGauge>(bindings);
  const auto timed = [](const Plan::PlaceEntry& place) { return place.timed; };
  watches_time_ = simulated_ || releases_.have_rate() || operations_.devices().watches_time() ||
                  std::any_of(plan_->places.begin(), plan_->places.end(), timed);
}

void SubsystemExecutor::enter() {
  for (const std::uint32_t place : plan_->known) put(place);
  put(plan_->in);
}

SubsystemExecutor::Progress SubsystemExecutor::step(std::uint64_t most) {
  const RunningSubsystem running(*this);
  if (watches_time_)
    renew_time();
  else
    time_is_known_ = false;
  if (blocked_since_ != Time::max()) waited_ += now_ - std::exchange(blocked_since_, Time::max());
  bool up_to_date = true;  // nothing has happened since the clock was read
  for (;;) {
    if (control_.stopping()) return {State::stopped};
    if (control_.paused()) return {State::ready};
    if (at_end_) {
      end();
      return {State::ended};
    }
    if (most-- == 0) return {State::ready};
    if (fire_one()) {
      up_to_date = false;
      if (simulated_ && time_stands_still())
        fault(marked_.front(), "time stands still: it fires for ever at one instant");
      continue;
    }
    if (advance_operations()) {
      up_to_date = false;
      continue;
    }
    if (outwait_peer()) continue;
    if (watches_time_ && !std::exchange(up_to_date, true)) {
      renew_time();
      continue;
    }
    operations_.devices().guard(now_, name_of(marked_.front()));
    if (!register_waits()) continue;
    if (watches_time_ && registrations_ > 0) blocked_since_ = now_;
    if (std::exchange(waits_after_, firings_) != firings_) {
      waits_since_ = now();
      gauges_.waits_since_ns.store(waits_since_.time_since_epoch().count(), std::memory_order_relaxed);
    }
    return {State::waiting, next_deadline(), operations_.devices().next_beat()};
  }
}

// -------------------------------------------------------------------------------------------- time

void SubsystemExecutor::renew_time() {
  now_ = clock_.now();
  time_is_known_ = true;
}

/// The time of the last user code, or a later one: firings take almost no time.
Time SubsystemExecutor::now() {
  if (!time_is_known_) renew_time();
  return now_;
}

// -------------------------------------------------------------------------------------------- firing

bool SubsystemExecutor::fire_one() {
  if (marked_.size() == 1) {
    if (walk()) return true;
    if (plan_->known.empty()) return false;
  }
  for (const std::uint32_t place : marked_) {
    if (tokens_[place].phase != Phase::finished) continue;
    if (const Plan::TransitionEntry* const fired = fire_one_of(places_[place].departure); fired != nullptr) {
      if (firings_ % look_up == 0) renew_time();
      move_tokens(*fired);
      return true;
    }
  }
  return false;
}

/// As fire_one if there is one token, the usual case; in real time it fires as far as it can. Meanwhile, no
/// token has a position: no transition that takes several tokens is enabled.
bool SubsystemExecutor::walk() {
  std::uint32_t place = marked_.front();
  const Plan::TransitionEntry* departure = places_[place].departure;
  tokens_[place].position = {};
  bool walked = false;
  for (std::uint32_t left = simulated_ ? 1 : look_up; tokens_[place].phase == Phase::finished; --left) {
    if (left == 0) {  // it checks the clock and whether the run is to stop
      renew_time();
      break;
    }
    const Plan::TransitionEntry* const fired = fire_one_of(departure);
    if (fired == nullptr) break;
    walked = true;
    if (!fired->to.valid()) {
      tokens_[place].position = {0};
      move_tokens(*fired);
      return true;
    }
    departure = fired->onward;
    place = marked_.front() = fired->to.value;
    arrive(place);
  }
  tokens_[place].position = {0};
  return walked;
}

/// Fires one of the departures of a place. The tokens have not moved yet.
inline const Plan::TransitionEntry* SubsystemExecutor::fire_one_of(const Plan::TransitionEntry* departure) {
  if (departure == nullptr) return nullptr;
  for (;; ++departure) {
    if ((departure->from.valid() || locally_enabled(*departure)) && fire_enabled(*departure))
      return departure;
    if (departure->last) return nullptr;
  }
}

bool SubsystemExecutor::try_fire(std::uint32_t index) {
  const Plan::TransitionEntry& transition = plan_->transitions[index];
  if (!locally_enabled(transition) || !fire_enabled(transition)) return false;
  move_tokens(transition);
  return true;
}

/// All of a firing except the tokens of the subsystem.
inline bool SubsystemExecutor::fire_enabled(const Plan::TransitionEntry& transition) {
  if (!condition_holds(transition)) return false;
  std::uint32_t version = 0;
  if (transition.port.valid()) {
    const PortLink& link = ports_[transition.port.value];
    version = link.channel->fire(link.side, transition.taken, transition.produced);
    if (version == 0) {
      if (link.channel->held()) held_ = link.channel;
      return false;
    }
    if (registrations_ != 0 && std::exchange(wants_[transition.port.value], std::uint16_t{0}) != 0)
      --registrations_;  // firing voids them
    if (link.end != nullptr) version = tell_network(*link.end, transition);
  }
  ++firings_;
  if (lane_ != nullptr) {
    renew_time();
    lane_->firing(now_, first_transition_ + transition.index, version);
    last_fired_ = transition.index;
  }
  if (transition.tells_of_timeout) tell_of_timeout(transition);
  return true;
}

/// Returns the number that the event contains instead of a version.
std::uint32_t SubsystemExecutor::tell_network(NetworkEnd& end, const Plan::TransitionEntry& transition) {
  if (lane_ != nullptr) renew_time();
  const bool elapsed = transition.guard.kind == Guard::Kind::elapsed;
  return end.fired({transition.taken, transition.produced, elapsed}, now_, lane_);
}

void SubsystemExecutor::tell_of_timeout(const Plan::TransitionEntry& transition) {
  if (transition.guard.kind == Guard::Kind::elapsed)
    operations_.note_timeout(transition.port.value);
  else
    operations_.note_answer(transition.port.value);
}

/// If some transition waits only for a peer that is reading or writing, waits actively: that is shorter than
/// a sleep.
bool SubsystemExecutor::outwait_peer() {
  const SharedChannel* const channel = std::exchange(held_, nullptr);
  return channel != nullptr && !simulated_ && channel->outwait();
}

bool SubsystemExecutor::locally_enabled(const Plan::TransitionEntry& transition) const {
  const auto has_finished = [this](std::uint32_t place) {
    return tokens_[place].position.valid() && tokens_[place].phase == Phase::finished;
  };
  const auto inputs = plan_->inputs(transition);
  return std::all_of(inputs.begin(), inputs.end(), has_finished);
}

bool SubsystemExecutor::wants_to_fire(std::uint32_t transition) const {
  return locally_enabled(plan_->transitions[transition]) && condition_holds(plan_->transitions[transition]);
}

Time SubsystemExecutor::elapses(const Plan::TransitionEntry& transition) const {
  const Duration timeout = operations_.parts().ports[transition.port.value].timeout;
  if (timeout == Duration::zero()) return Time::max();
  Time arrival = Time::min();
  for (const std::uint32_t place : plan_->inputs(transition))
    arrival = std::max(arrival, tokens_[place].arrival);
  return arrival + timeout;
}

// -------------------------------------------------------------------------------------------- tokens,
// operations

void SubsystemExecutor::move_tokens(const Plan::TransitionEntry& transition) {
  for (const std::uint32_t place : plan_->inputs(transition)) take(place);
  for (const std::uint32_t place : plan_->outputs(transition)) put(place);
}

void SubsystemExecutor::take(std::uint32_t place) {
  if (places_[place].fact) {
    tokens_[place].position = {};
    return;
  }
  const MarkedId hole = std::exchange(tokens_[place].position, MarkedId{});
  marked_[hole.value] = marked_.back();
  tokens_[marked_[hole.value]].position = hole;
  tokens_[place].position = {};  // also when it was the last itself
  marked_.pop_back();
}

void SubsystemExecutor::put(std::uint32_t place) {
  Token& token = tokens_[place];
  if (token.position.valid()) return fault(place, "a place got a second token: the net is not safe");
  if (places_[place].fact) {
    token.position = {0};
  } else {
    token.position = {static_cast<std::uint32_t>(marked_.size())};
    marked_.push_back(place);
  }
  arrive(place);
}

/// Starts the operation.
inline void SubsystemExecutor::arrive(std::uint32_t place) {
  const Plan::PlaceEntry& entry = places_[place];
  Token& token = tokens_[place];
  token.phase = Phase::finished;
  if (entry.idle) return;
  if (entry.timed) {
    renew_time();
    token.arrival = now_;
  }
  switch (entry.does) {
    case Does::Kind::nothing:
      if (place == plan_->out) arrive_at_end();
      break;
    case Does::Kind::call:
      token.phase = Phase::released_later;
      token.due = plan_->receive_first ? Time::min() : release();
      break;
    case Does::Kind::begin:
      operations_.begin_iteration(entry.subject);
      token.phase = Phase::released_later;
      token.due = release();
      break;
    case Does::Kind::count:
      operations_.count();
      break;
    case Does::Kind::write:
      operations_.write(entry.subject, entry.slot, now());
      break;
    case Does::Kind::read:
      operations_.read(entry.subject, entry.slot, now());
      if (entry.tells) take_told(place);
      break;
    case Does::Kind::decide:
      decide(place);
      break;
    case Does::Kind::route:
      route(place);
      break;
    case Does::Kind::ask:
      ask(place);
      break;
    case Does::Kind::know:
      operations_.learn(entry.subject, entry.slot, now());
      if (memory_ != nullptr) memory_->show();
      break;
  }
}

/// A decision without a transition would leave the token where it is for ever.
inline void SubsystemExecutor::check_way_out(std::uint32_t place) {
  const std::int32_t decided = tokens_[place].latched;
  if (decided < 64 && (places_[place].ways >> decided & 1U) != 0) return;
  look_for_way_out(place);
}

bool SubsystemExecutor::fits_facts(const Plan::TransitionEntry& transition) const {
  const auto inputs = plan_->inputs(transition);
  return std::all_of(inputs.begin(), inputs.end(), [this](std::uint32_t input) {
    return !places_[input].fact || tokens_[input].position.valid();
  });
}

void SubsystemExecutor::look_for_way_out(std::uint32_t place) {
  const auto leaving = plan_->leaving_of(place);
  const auto may_fire = [&](std::uint32_t index) {
    return condition_holds(plan_->transitions[index]) && fits_facts(plan_->transitions[index]);
  };
  if (std::none_of(leaving.begin(), leaving.end(), may_fire))
    fault(place, "what was decided has no transition: the generated code does not fit its net");
}

void SubsystemExecutor::decide(std::uint32_t place) {
  Token& token = tokens_[place];
  if (const Plan::TransitionEntry* const next = decided_by_script(place)) {
    operations_.accept_outcome(static_cast<Outcome>(next->decided));
    token.latched = next->decided;
    return;
  }
  token.latched = static_cast<std::int32_t>(operations_.decide(places_[place].subject, time_of_conditions()));
  check_way_out(place);
}

void SubsystemExecutor::route(std::uint32_t place) {
  Token& token = tokens_[place];
  if (const Plan::TransitionEntry* next = decided_by_script(place)) {
    token.latched = next->guard.entry;
    return;
  }
  token.latched = Operations::no_entry;
  if (script_ends_without_choice()) return;
  token.latched = operations_.route(places_[place].subject, time_of_conditions());
  if (token.latched == Operations::no_entry) fault(place, "no condition of `next` holds");
  if (token.latched == Operations::unknown_entry) fault(place, "a condition of `next` has thrown");
  if (token.latched >= 0) check_way_out(place);
}

void SubsystemExecutor::ask(std::uint32_t place) {
  Token& token = tokens_[place];
  const Plan::PlaceEntry& entry = places_[place];
  if (const Plan::TransitionEntry* next = decided_by_script(place)) {
    token.latched = next->decided;
  } else {
    token.latched =
        static_cast<std::int32_t>(operations_.sends(entry.slot, entry.subject, time_of_conditions()));
    check_way_out(place);
  }
  if (token.latched == 0) operations_.note_answer(entry.subject);  // what was not sent has not timed out
}

void SubsystemExecutor::arrive_at_end() {
  at_end_ = true;
  if (operations_.ended_by_error())
    fault(plan_->out, "ended by an error that no `next` leads to another behaviour");
}

bool SubsystemExecutor::advance_operations() {
  for (const std::uint32_t place : marked_)
    if (tokens_[place].phase != Phase::finished && now_ >= tokens_[place].due && advance(place)) return true;
  return false;
}

void SubsystemExecutor::wake_receivers() {
  for (const PortLink& port : operations_.parts().ports)
    if (port.side == Side::send && port.peer.valid()) waker_.wake(port.peer.value);
}

// -------------------------------------------------------------------------------------------- ends
void SubsystemExecutor::fault(std::uint32_t place, std::string_view text) {
  operations_.reports().report(Fault::net, name_of(place), text);
  operations_.reports().fail_run(text);
}

void SubsystemExecutor::end() {
  operations_.present().end(now());
  static_cast<void>(register_waits());  // withdraws: no other subsystem must yield to one that has ended
  leave();
  control_.mark_ended(index_);
  wake_receivers();
}

}  // namespace tessera
