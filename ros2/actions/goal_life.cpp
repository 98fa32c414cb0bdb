#include "ros2/actions/goal_life.hpp"

#include <algorithm>
#include <utility>

namespace tessera::ros2 {
namespace {

constexpr std::size_t most_formers = 32;

bool is_state_under_way(std::int8_t status) {
  return status >= static_cast<std::int8_t>(GoalState::accepted) &&
         status <= static_cast<std::int8_t>(GoalState::canceling);
}
bool is_state_of_end(std::int8_t status) {
  return status >= static_cast<std::int8_t>(GoalState::succeeded) &&
         status <= static_cast<std::int8_t>(GoalState::aborted);
}

}  // namespace

void GoalLife::order(std::uint64_t call, bool cancel, std::span<const std::byte> goal, Instant now) {
  if (call != 0 && call != call_) begin(call, goal, now);
  if (cancel || call == 0) wants_cancel_ = state_ != GoalState::none;
  tick(now);
}

void GoalLife::begin(std::uint64_t call, std::span<const std::byte> goal, Instant now) {
  if (is_under_way(state_) || (state_ == GoalState::ordered && is_sent_)) give_up(has_cancelled_);
  events_.clear();  // whoever orders a goal is done with the last one
  call_ = call;
  id_ = new_id_();
  state_ = GoalState::none;
  goal_.assign(goal.begin(), goal.end());
  feedback_.clear();
  is_sent_ = wants_cancel_ = has_cancelled_ = false;
  early_status_ = 0;
  answer_until_ = now + times_.timeout;
  cancel_until_.reset();
  result_until_.reset();
  probed_at_.reset();
  change(GoalState::ordered);
}

/// Precondition: may_follow(state_, state).
void GoalLife::change(GoalState state, Bytes result) {
  state_ = state;
  events_.push_back({call_, state, feedback_, std::move(result)});
}

/// The server may work for the goal, or begin to do so. If it is not there, the goal is cancelled when it comes
/// back and says that it still works for it.
void GoalLife::give_up(bool cancelled) {
  const bool accepted = is_under_way(state_);
  formers_.push_back({id_, cancelled});
  if (accepted && !cancelled && is_there_) cancel(formers_.back());
  if (formers_.size() > most_formers) formers_.pop_front();
}

void GoalLife::lose() {
  if (is_sent_) give_up(/*cancelled=*/false);
  answer_until_.reset();
  cancel_until_.reset();
  result_until_.reset();
  change(GoalState::gone);
}

void GoalLife::cancel(Former& former) {
  former.cancelled = true;
  do_it(Deed::Kind::cancel, former.id);
}

GoalLife::Former* GoalLife::former(const GoalId& id) {
  const auto found = std::ranges::find(formers_, id, &Former::id);
  return found == formers_.end() ? nullptr : &*found;
}

void GoalLife::hear_of_server(bool is_there, Instant now) {
  const bool has_left = is_there_ && !is_there;
  is_there_ = is_there;
  if (has_left) {
    for (Former& one : formers_) one.cancelled = false;  // it may come back, with the goal
    if (is_under_way(state_) || (state_ == GoalState::ordered && is_sent_)) {
      ++counts_.lost;
      lose();
    }
  }
  tick(now);
}

void GoalLife::hear_answer(const GoalId& id, bool accepted, Instant now) {
  if (id != id_ || state_ != GoalState::ordered || !is_sent_) {
    Former* const one = former(id);
    if (one == nullptr && accepted && (id != id_ || is_end(state_))) {
      ++counts_.repeated;
      do_it(Deed::Kind::cancel, id);
    } else if (one == nullptr) {
      ++(id == id_ && state_ != GoalState::none ? counts_.disorder : counts_.unknown);
    } else if (!accepted) {
      std::erase_if(formers_, [&](const Former& each) { return each.id == id; });
    } else if (!one->cancelled) {
      ++counts_.late_acceptance;
      cancel(*one);
    } else {
      ++counts_.given_up;
    }
    return;
  }
  answer_until_.reset();
  if (!accepted) return change(GoalState::rejected);
  next_probe_ = now + times_.between_probes();
  probed_at_.reset();
  Bytes early = std::exchange(feedback_, {});
  change(GoalState::accepted);
  do_it(Deed::Kind::ask_result, id_);
  if (early_status_ != 0) apply_status(std::exchange(early_status_, 0), now);
  if (!early.empty()) hear_feedback(id_, std::move(early));
  tick(now);
}

void GoalLife::hear_result(const GoalId& id, std::optional<std::int8_t> status, Bytes message, Instant now) {
  if (id != id_ || !is_under_way(state_)) {
    if (former(id) != nullptr) {
      std::erase_if(formers_, [&](const Former& each) { return each.id == id; });
      ++counts_.given_up;
    } else {
      ++(id == id_ && state_ != GoalState::none ? counts_.disorder : counts_.unknown);
    }
    return;
  }
  cancel_until_.reset();
  result_until_.reset();
  if (status && is_state_of_end(*status)) return change(static_cast<GoalState>(*status), std::move(message));
  // A server that has been started again meanwhile does not know the goal: 0.
  ++counts_.unreadable;
  lose();
  tick(now);
}

void GoalLife::hear_status(const GoalId& id, std::int8_t status, Instant now) {
  if (Former* const one = former(id)) {
    ++counts_.given_up;
    if (is_state_under_way(status) && !one->cancelled) cancel(*one);
    return;
  }
  if (id != id_ || state_ == GoalState::none) {
    ++counts_.unknown;
    return;
  }
  if (state_ == GoalState::ordered && is_sent_)
    early_status_ = std::max(early_status_, status);
  else
    apply_status(status, now);
}

/// A state that is older than what is known is no disorder: the topics are not in step.
void GoalLife::apply_status(std::int8_t status, Instant now) {
  if (!is_under_way(state_)) {
    if (!is_end(state_) || !(is_state_under_way(status) || is_state_of_end(status))) ++counts_.disorder;
    return;
  }
  if (is_state_under_way(status)) {
    if (const auto state = static_cast<GoalState>(status); state > state_) change(state);
  } else if (is_state_of_end(status)) {
    if (!result_until_) result_until_ = now + times_.timeout;  // the result tells the end
  } else {
    ++counts_.disorder;
  }
}

void GoalLife::hear_feedback(const GoalId& id, Bytes message) {
  if (id != id_ || state_ == GoalState::none) {
    ++(former(id) != nullptr ? counts_.given_up : counts_.unknown);
    return;
  }
  if (state_ == GoalState::ordered && is_sent_) {
    feedback_ = std::move(message);
    return;
  }
  if (!is_under_way(state_)) {
    ++counts_.disorder;
    return;
  }
  feedback_ = std::move(message);
  if (state_ == GoalState::accepted) return change(GoalState::executing);  // servers need not publish states
  if (!events_.empty())
    events_.back().feedback = feedback_;
  else
    events_.push_back({call_, state_, feedback_, {}});
}

void GoalLife::hear_of_cancel(const GoalId& id, CancelCode code, Instant now) {
  if (id != id_ || !is_under_way(state_) || !cancel_until_) {
    const bool known = former(id) != nullptr || (id == id_ && state_ != GoalState::none);
    if (!known) ++counts_.unknown;
    if (known && code == CancelCode::refused) ++counts_.uncancelled;
    if (former(id) != nullptr && (code == CancelCode::unknown_goal || code == CancelCode::goal_has_ended))
      std::erase_if(formers_, [&](const Former& each) { return each.id == id; });
    return;
  }
  cancel_until_.reset();
  switch (code) {
    case CancelCode::good:
      if (state_ < GoalState::canceling) change(GoalState::canceling);
      return;
    case CancelCode::goal_has_ended:
      if (!result_until_) result_until_ = now + times_.timeout;
      return;
    case CancelCode::unknown_goal:
      ++counts_.lost;
      return lose();
    default:
      ++counts_.uncancelled;
  }
}

void GoalLife::ask_to_cancel(Instant now) {
  has_cancelled_ = true;
  cancel_until_ = now + times_.timeout;
  do_it(Deed::Kind::cancel, id_);
}

void GoalLife::tick(Instant now) {
  if (state_ == GoalState::ordered && !is_sent_) {
    if (wants_cancel_ || now >= *answer_until_) {
      if (!wants_cancel_) ++counts_.unserved;
      return lose();
    }
    if (!is_there_) return;
    is_sent_ = true;
    answer_until_ = now + times_.timeout;
    do_it(Deed::Kind::send_goal, id_, std::exchange(goal_, {}));
    return;
  }
  const auto is_over = [now](const std::optional<Instant>& until) { return until && now >= *until; };
  if (state_ == GoalState::ordered) {
    if (!is_over(answer_until_)) return;
    ++counts_.unanswered;
    return lose();
  }
  if (!is_under_way(state_)) return;
  if (wants_cancel_ && !has_cancelled_) ask_to_cancel(now);
  const bool silent = probed_at_ && now - *probed_at_ >= times_.longest_silence();
  if (silent || is_over(cancel_until_) || is_over(result_until_)) {
    ++(silent ? counts_.lost : counts_.unanswered);
    return lose();
  }
  if (probed_at_ || now < next_probe_) return;
  probed_at_ = now;
  next_probe_ = now + times_.between_probes();
  do_it(Deed::Kind::probe, id_);
}

bool GoalLife::is_busy() const {
  return is_under_way(state_) || state_ == GoalState::ordered ||
         std::ranges::any_of(formers_, [](const Former& one) { return !one.cancelled; });
}

std::vector<GoalLife::Deed> GoalLife::take_deeds() { return std::exchange(deeds_, {}); }

std::optional<GoalLife::Event> GoalLife::take_event() {
  if (events_.empty()) return std::nullopt;
  Event event = std::move(events_.front());
  events_.pop_front();
  return event;
}

}  // namespace tessera::ros2
