// How a subsystem follows a script: the transitions of a scenario in their order.

#include <algorithm>
#include <string_view>

#include "subsystem/subsystem_executor.hpp"

namespace tessera {
namespace {

std::string_view forced_by(Guard::Kind guard) {
  switch (guard) {
    case Guard::Kind::go_on:
      return "neither error nor terminal";
    case Guard::Kind::terminal:
      return "terminal";
    case Guard::Kind::error:
      return "error";
    case Guard::Kind::next:
      return "this initial condition";
    case Guard::Kind::send:
      return "to send";
    case Guard::Kind::skip:
      return "to send nothing";
    case Guard::Kind::told:
      return "what is told of the goal";
    case Guard::Kind::none:
    case Guard::Kind::elapsed:  // the script has waited for it
      break;
  }
  return "";
}

}  // namespace

SubsystemExecutor::FollowProgress SubsystemExecutor::follow() {
  const std::optional<std::uint32_t> transition = script_[followed_++];
  if (!transition) {
    fault(marked_.front(), "no condition of `next` holds");
    return {Followed::fired, Time::max(), "no initial condition"};
  }
  renew_time();
  while (advance_operations()) continue;
  operations_.devices().guard(now_, name_of(marked_.front()));
  if (!try_fire(*transition)) {
    --followed_;
    return {Followed::waiting, script_deadline(*transition)};
  }
  if (at_end_) end();
  return {at_end_ ? Followed::ended : Followed::fired, Time::max(),
          forced_by(plan_->transitions[*transition].guard.kind)};
}

/// The transition of the script that will take a token that has just arrived; nullptr: there is none.
const Plan::TransitionEntry* SubsystemExecutor::decided_by_script(std::uint32_t place) const {
  for (std::size_t index = followed_; index < script_.size(); ++index) {
    if (!script_[index]) continue;
    const Plan::TransitionEntry& transition = plan_->transitions[*script_[index]];
    if (transition.latch.value == place) return &transition;
  }
  return nullptr;
}

/// Latches the state of the goal that the value tells of, or the one that the script says.
void SubsystemExecutor::take_told(std::uint32_t place) {
  const Plan::TransitionEntry* const next = decided_by_script(place);
  tokens_[place].latched = next != nullptr ? next->decided : operations_.told(places_[place].subject);
}

bool SubsystemExecutor::script_ends_without_choice() const {
  return followed_ < script_.size() && !script_[followed_];
}

/// The time at which an operation that the transition waits for has finished, or its timeout has passed.
Time SubsystemExecutor::script_deadline(std::uint32_t index) const {
  const Plan::TransitionEntry& transition = plan_->transitions[index];
  Time deadline = Time::max();
  for (const std::uint32_t place : marked_)
    if (tokens_[place].phase != Phase::finished) deadline = std::min(deadline, tokens_[place].due);
  if (deadline != Time::max() || transition.guard.kind != Guard::Kind::elapsed) return deadline;
  const Time elapsed = locally_enabled(transition) ? elapses(transition) : Time::max();
  return elapsed > now_ ? elapsed : Time::max();
}

}  // namespace tessera
