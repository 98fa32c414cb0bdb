#include "subsystem_executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "console.hpp"

namespace tessera {

SubsystemExecutor::SubsystemExecutor(std::uint32_t index, SubsystemParts parts,
                                     std::shared_ptr<const Plan> plan, std::uint32_t first_transition,
                                     Shared shared, RecordingLane* lane)
    : index_(index),
      operations_(std::move(parts), shared.control, shared.clock, lane),
      plan_(std::move(plan)),
      first_transition_(first_transition),
      control_(shared.control),
      clock_(shared.clock),
      waker_(shared.waker),
      lane_(lane),
      tokens_(plan_->places.size()),
      wants_(plan_->ports.size()),
      wants_next_(plan_->ports.size()) {
  marked_.reserve(plan_->places.size());
}

void SubsystemExecutor::enter() { put(plan_->in, clock_.now()); }

SubsystemExecutor::Progress SubsystemExecutor::step(std::uint64_t most) {
  if (blocked_since_ != Time::max()) waited_ += clock_.now() - std::exchange(blocked_since_, Time::max());
  for (;;) {
    if (control_.stopping()) return {State::stopped};
    if (tokens_[plan_->out].position != Plan::none) {
      end();
      return {State::ended};
    }
    if (most-- == 0) return {State::ready};
    const Time now = clock_.now();
    if (fire_one(now)) {
      if (time_stands_still(now))
        fault(marked_.front(), "time stands still: it fires for ever at one instant");
      continue;
    }
    if (advance_operations(now)) continue;
    operations_.guard_effectors(now, name_of(marked_.front()));
    if (!register_waits(now)) continue;
    if (registrations_ > 0) blocked_since_ = now;
    return {State::waiting, next_deadline()};
  }
}

// -------------------------------------------------------------------------------------------- firing

bool SubsystemExecutor::fire_one(Time now) {
  for (const std::uint32_t place : marked_)
    for (const std::uint32_t transition : plan_->leaving_of(place))
      if (try_fire(transition, now)) return true;  // marked_ has changed
  return false;
}

bool SubsystemExecutor::try_fire(std::uint32_t index, Time now) {
  const Plan::TransitionEntry& transition = plan_->transitions[index];
  if (!locally_enabled(transition) || !condition_holds(transition, now)) return false;
  std::uint32_t version = 0;
  if (transition.port != Plan::none) {
    const PortLink& link = operations_.parts().ports[transition.port];
    version = link.channel->fire(link.side, transition.need, transition.produced);
    if (version == 0) return false;
    if (std::exchange(wants_[transition.port], std::uint16_t{0}) != 0) --registrations_;  // firing voids them
  }
  after_firing(index, version, now);
  return true;
}

bool SubsystemExecutor::locally_enabled(const Plan::TransitionEntry& transition) const {
  for (const std::uint32_t place : plan_->inputs(transition)) {
    const Token& token = tokens_[place];
    if (token.position == Plan::none || token.phase != Phase::finished) return false;
  }
  return true;
}

bool SubsystemExecutor::condition_holds(const Plan::TransitionEntry& transition, Time now) const {
  switch (transition.guard.kind) {
    case Guard::Kind::none:
      return true;
    case Guard::Kind::go_on:
      return tokens_[transition.latch].latched == static_cast<std::int32_t>(Outcome::go_on);
    case Guard::Kind::terminal:
      return tokens_[transition.latch].latched == static_cast<std::int32_t>(Outcome::terminal);
    case Guard::Kind::error:
      return tokens_[transition.latch].latched == static_cast<std::int32_t>(Outcome::error);
    case Guard::Kind::next:
      return tokens_[transition.latch].latched == transition.guard.entry;
    case Guard::Kind::elapsed:
      return now >= elapses(transition);
  }
  return false;
}

Time SubsystemExecutor::elapses(const Plan::TransitionEntry& transition) const {
  const Duration timeout = operations_.parts().ports[transition.port].timeout;
  if (timeout == Duration::zero()) return Time::max();
  Time arrival = Time::min();
  for (const std::uint32_t place : plan_->inputs(transition))
    arrival = std::max(arrival, tokens_[place].arrival);
  return arrival + timeout;
}

void SubsystemExecutor::after_firing(std::uint32_t index, std::uint32_t version, Time now) {
  const Plan::TransitionEntry& transition = plan_->transitions[index];
  ++firings_;
  if (lane_ != nullptr) lane_->firing(now, first_transition_ + index, version);
  if (transition.guard.kind == Guard::Kind::elapsed)
    operations_.note_timeout(transition.port);
  else if (transition.answers_in_time && transition.port != Plan::none)
    operations_.note_answer(transition.port);
  for (const std::uint32_t place : plan_->inputs(transition)) take(place);
  for (const std::uint32_t place : plan_->outputs(transition)) put(place, now);
}

// -------------------------------------------------------------------------------------------- tokens,
// operations

void SubsystemExecutor::take(std::uint32_t place) {
  const std::uint32_t hole = std::exchange(tokens_[place].position, Plan::none);
  marked_[hole] = marked_.back();
  tokens_[marked_[hole]].position = hole;
  tokens_[place].position = Plan::none;  // also when it was the last itself
  marked_.pop_back();
}

void SubsystemExecutor::put(std::uint32_t place, Time now) {
  Token& token = tokens_[place];
  if (token.position != Plan::none) return fault(place, "a place got a second token: the net is not safe");
  token.position = static_cast<std::uint32_t>(marked_.size());
  token.arrival = now;
  token.phase = Phase::finished;
  marked_.push_back(place);
  start_operation(place, now);
}

void SubsystemExecutor::start_operation(std::uint32_t place, Time now) {
  const Plan::PlaceEntry& entry = plan_->places[place];
  Token& token = tokens_[place];
  switch (entry.does) {
    case Does::Kind::nothing:
      if (place == plan_->out) arrive_at_end();
      break;
    case Does::Kind::call:
      token.phase = Phase::released_later;
      token.due = release(now);
      break;
    case Does::Kind::count:
      operations_.count();
      break;
    case Does::Kind::write:
      operations_.write(entry.subject, entry.slot, now);
      break;
    case Does::Kind::read:
      operations_.read(entry.subject, entry.slot, now);
      break;
    case Does::Kind::decide:
      decide(place, now);
      break;
    case Does::Kind::route:
      route(place, now);
      break;
  }
}

void SubsystemExecutor::decide(std::uint32_t place, Time now) {
  Token& token = tokens_[place];
  if (const Plan::TransitionEntry* next = decided_by_script(place)) {
    const Outcome outcome = next->guard.kind == Guard::Kind::error      ? Outcome::error
                            : next->guard.kind == Guard::Kind::terminal ? Outcome::terminal
                                                                        : Outcome::go_on;
    operations_.accept_outcome(outcome);
    token.latched = static_cast<std::int32_t>(outcome);
    return;
  }
  token.latched = static_cast<std::int32_t>(operations_.decide(plan_->places[place].subject, now));
  check_way_out(place, now);
}

void SubsystemExecutor::route(std::uint32_t place, Time now) {
  Token& token = tokens_[place];
  if (const Plan::TransitionEntry* next = decided_by_script(place)) {
    token.latched = next->guard.entry;
    return;
  }
  token.latched = Operations::no_entry;
  if (script_ends_without_choice()) return;
  token.latched = operations_.route(plan_->places[place].subject, now);
  if (token.latched == Operations::no_entry) fault(place, "no condition of `next` holds");
  if (token.latched == Operations::unknown_entry) fault(place, "a condition of `next` has thrown");
  if (token.latched >= 0) check_way_out(place, now);
}

/// A decision without a transition would leave the token where it is for ever.
void SubsystemExecutor::check_way_out(std::uint32_t place, Time now) {
  const auto leaving = plan_->leaving_of(place);
  const auto may_fire = [&](std::uint32_t index) { return condition_holds(plan_->transitions[index], now); };
  if (std::none_of(leaving.begin(), leaving.end(), may_fire))
    fault(place, "what was decided has no transition: the generated code does not fit its net");
}

void SubsystemExecutor::arrive_at_end() {
  if (operations_.ended_by_error())
    fault(plan_->out, "ended by an error that no `next` leads to another behaviour");
}

Time SubsystemExecutor::release(Time arrival) {
  const Instance& instance = *operations_.parts().instance;
  const Duration period = instance.period;
  const Duration waited = std::exchange(waited_, Duration::zero());
  if (period == Duration::zero()) return arrival;
  const auto first_not_before = [&](Time time) {
    return (time.time_since_epoch() + period - Duration(1)) / period;
  };
  if (next_release_ < 0) {
    next_release_ = arrival.time_since_epoch() / period;  // the first call starts at once
  } else {
    const std::int64_t now = first_not_before(arrival), without_waiting = first_not_before(arrival - waited);
    count_overruns(without_waiting, arrival);
    if (instance.policies.overrun == Overrun::skip)
      next_release_ = std::max(next_release_, now);
    else
      next_release_ =
          std::max(next_release_, now - std::max<std::int64_t>(0, without_waiting - next_release_));
  }
  return Time(period * next_release_++);
}

/// Instants before `end` that no call has been made for.
void SubsystemExecutor::count_overruns(std::int64_t end, Time now) {
  const std::int64_t missed = end - std::max(next_release_, counted_to_);
  if (missed <= 0) return;
  counted_to_ = end;
  overruns_ += static_cast<std::uint64_t>(missed);
  if (lane_ != nullptr)
    lane_->overrun(now, static_cast<std::uint32_t>(std::min<std::int64_t>(missed, UINT32_MAX)));
}

bool SubsystemExecutor::advance_operations(Time now) {
  for (const std::uint32_t place : marked_)
    if (tokens_[place].phase != Phase::finished && now >= tokens_[place].due && advance(place, now))
      return true;
  return false;
}

/// Begins or ends a transition function; false when that has to wait.
bool SubsystemExecutor::advance(std::uint32_t place, Time now) {
  Token& token = tokens_[place];
  if (token.phase == Phase::released_later) {
    // User code may take long: nobody must be held back meanwhile by a wait that is over.
    if (registrations_ > 0 && !register_waits(now)) return true;
    const std::uint16_t behaviour = plan_->places[place].subject;
    gauges_.begin_call(behaviour, now);
    operations_.start_call(behaviour, now);
    token.phase = Phase::running;
    token.due = clock_.simulated() ? now + operations_.takes(behaviour) : now;
    const Duration watchdog = operations_.parts().instance->policies.watchdog;
    if (watchdog > Duration::zero() && token.due > now + watchdog)
      returns_ = std::exchange(token.due, now + watchdog + Duration(1));
    if (token.due > now) return true;
  }
  if (returns_ != Time{}) {
    token.due = std::exchange(returns_, Time{});
    raise_alarm(gauges_.called_at_ns.load(std::memory_order_relaxed), lane_);
    return true;
  }
  const Time done = clock_.now();
  operations_.finish_call(done);
  gauges_.end_call(done);
  if (operations_.parts().instance->policies.watchdog > Duration::zero()) end_alarm();
  show();
  token.phase = Phase::finished;
  return true;
}

void SubsystemExecutor::raise_alarm(std::int64_t since_ns, RecordingLane* lane) {
  control_.mark_stalled(index_, true);
  // Either this sees that the call is over, or the subsystem's thread sees the mark.
  std::atomic_thread_fence(std::memory_order_seq_cst);
  if (!gauges_.calling.load(std::memory_order_relaxed) ||
      gauges_.called_at_ns.load(std::memory_order_relaxed) != since_ns)
    return control_.mark_stalled(index_, false);
  operations_.report_stall(gauges_.behaviour.load(std::memory_order_relaxed), lane);
  if (!operations_.give_safe_command_from_outside())
    console::print(LogLevel::error, clock_.now(), path(),
                   "its devices are in use, or refuse the safe command");
  wake_receivers();
}

void SubsystemExecutor::end_alarm() {
  std::atomic_thread_fence(std::memory_order_seq_cst);
  if (!control_.is_stalled(index_)) return;
  control_.mark_stalled(index_, false);
  wake_receivers();
}

void SubsystemExecutor::wake_receivers() {
  for (const PortLink& port : operations_.parts().ports)
    if (port.side == Side::send && port.peer != UINT32_MAX) waker_.wake(port.peer);
}

/// Once an iteration, for those who watch.
void SubsystemExecutor::show() {
  gauges_.iterations.store(operations_.iterations(), std::memory_order_relaxed);
  gauges_.errors.store(operations_.errors(), std::memory_order_relaxed);
  gauges_.firings.store(firings_, std::memory_order_relaxed);
  gauges_.overruns.store(overruns_, std::memory_order_relaxed);
}

// -------------------------------------------------------------------------------------------- scripts

namespace {

std::string_view forced_by(const Guard& guard) {
  switch (guard.kind) {
    case Guard::Kind::go_on:
      return "neither error nor terminal";
    case Guard::Kind::terminal:
      return "terminal";
    case Guard::Kind::error:
      return "error";
    case Guard::Kind::next:
      return "this initial condition";
    case Guard::Kind::none:
    case Guard::Kind::elapsed:  // waited for
      break;
  }
  return "";
}

}  // namespace

SubsystemExecutor::FollowProgress SubsystemExecutor::follow() {
  const std::uint32_t transition = script_[followed_++];
  if (transition == Plan::none) {
    fault(marked_.front(), "no condition of `next` holds");
    return {Followed::fired, Time::max(), "no initial condition"};
  }
  const Time now = clock_.now();
  while (advance_operations(now)) continue;
  operations_.guard_effectors(now, name_of(marked_.front()));
  if (!try_fire(transition, now)) {
    --followed_;
    return {Followed::waiting, script_deadline(transition)};
  }
  const bool over = tokens_[plan_->out].position != Plan::none;
  if (over) end();
  return {over ? Followed::ended : Followed::fired, Time::max(),
          forced_by(plan_->transitions[transition].guard)};
}

/// The transition of the script that will take a token that has just arrived; nullptr: none of it.
const Plan::TransitionEntry* SubsystemExecutor::decided_by_script(std::uint32_t place) const {
  for (std::size_t index = followed_; index < script_.size(); ++index) {
    if (script_[index] == Plan::none) continue;
    const Plan::TransitionEntry& transition = plan_->transitions[script_[index]];
    if (transition.latch == place) return &transition;
  }
  return nullptr;
}

bool SubsystemExecutor::script_ends_without_choice() const {
  return followed_ < script_.size() && script_[followed_] == Plan::none;
}

/// When an operation has finished that the transition waits for, or its timeout has passed.
Time SubsystemExecutor::script_deadline(std::uint32_t index) const {
  const Plan::TransitionEntry& transition = plan_->transitions[index];
  Time deadline = Time::max();
  for (const std::uint32_t place : marked_)
    if (tokens_[place].phase != Phase::finished) deadline = std::min(deadline, tokens_[place].due);
  if (deadline != Time::max() || transition.guard.kind != Guard::Kind::elapsed) return deadline;
  const Time elapsed = locally_enabled(transition) ? elapses(transition) : Time::max();
  return elapsed > clock_.now() ? elapsed : Time::max();
}

// -------------------------------------------------------------------------------------------- waiting

/// Registers in every channel exactly what this subsystem waits for; false: something may be taken after all.
bool SubsystemExecutor::register_waits(Time now) {
  std::fill(wants_next_.begin(), wants_next_.end(), std::uint16_t{0});
  for (const std::uint32_t place : marked_) {
    for (const std::uint32_t index : plan_->leaving_of(place)) {
      const Plan::TransitionEntry& transition = plan_->transitions[index];
      if (transition.need == SharedChannel::no_need || !locally_enabled(transition)) continue;
      if (!condition_holds(transition, now)) continue;
      wants_next_[transition.port] =
          static_cast<std::uint16_t>(wants_next_[transition.port] | 1U << transition.need);
    }
  }
  for (std::size_t port = 0; port < wants_.size(); ++port) {
    if (wants_[port] == 0 && wants_next_[port] == 0) continue;
    const PortLink& link = operations_.parts().ports[port];
    if (!link.channel->wait(link.side, wants_next_[port])) return false;
    registrations_ +=
        static_cast<std::uint32_t>(wants_next_[port] != 0) - static_cast<std::uint32_t>(wants_[port] != 0);
    wants_[port] = wants_next_[port];
  }
  return true;
}

Time SubsystemExecutor::next_deadline() const {
  Time deadline = operations_.guard_deadline();
  for (const std::uint32_t place : marked_) {
    const Token& token = tokens_[place];
    if (token.phase != Phase::finished) {
      deadline = std::min(deadline, token.due);
      continue;
    }
    for (const std::uint32_t index : plan_->leaving_of(place)) {
      const Plan::TransitionEntry& transition = plan_->transitions[index];
      if (transition.guard.kind != Guard::Kind::elapsed || !locally_enabled(transition)) continue;
      const Time elapsed = elapses(transition);
      const bool registered =
          transition.need != SharedChannel::no_need && (wants_[transition.port] >> transition.need & 1) != 0;
      if (!registered)
        deadline = std::min(deadline, elapsed);  // registered: it has elapsed and waits for its channel
    }
  }
  return deadline;
}

bool SubsystemExecutor::time_stands_still(Time now) {
  if (!clock_.simulated()) return false;
  if (now != instant_) {
    instant_ = now;
    fired_at_instant_ = 0;
  }
  return ++fired_at_instant_ > firings_per_instant;
}

// -------------------------------------------------------------------------------------------- ends

void SubsystemExecutor::fault(std::uint32_t place, std::string_view text) {
  operations_.report(Fault::net, name_of(place), text);
  std::array<char, 512> reason;
  const auto end = fmt::format_to_n(reason.data(), reason.size(), "{}: {}", path(), text);
  control_.request_stop({reason.data(), std::min(end.size, reason.size())}, /*fault=*/true);
}

void SubsystemExecutor::end() {
  static_cast<void>(
      register_waits(clock_.now()));  // withdraws: nobody must yield to a subsystem that has ended
  leave();
  control_.mark_ended(index_);
  wake_receivers();
}

std::string SubsystemExecutor::whereabouts(const System& system) const {
  const Instance& instance = *operations_.parts().instance;
  std::string text = path();
  for (const std::uint32_t place : marked_) {
    text += fmt::format(" at {}", instance.net->places[place].name);
    for (const std::uint32_t index : plan_->leaving_of(place)) {
      const Plan::TransitionEntry& transition = plan_->transitions[index];
      if (transition.port == Plan::none) continue;
      const std::uint32_t peer = operations_.parts().ports[transition.port].peer;
      const std::string_view port = instance.net->ports[transition.port].name;
      if (peer == UINT32_MAX)
        text += fmt::format(" waits for the other end of '{}', which no behaviour uses", port);
      else
        text += fmt::format(" waits for {}.{} over '{}'{}", system.instances[peer].agent,
                            system.instances[peer].name, port,
                            control_.has_ended(peer) ? ", which has ended" : "");
      break;
    }
  }
  return text;
}

}  // namespace tessera
