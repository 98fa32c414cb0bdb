#include "ros2/actions/served_goals.hpp"

#include <algorithm>
#include <utility>

#include "ros2/codec/cdr.hpp"

namespace tessera::ros2 {
namespace {

using State = GoalState;

bool is_open(State state) { return state == State::none || is_under_way(state); }
bool is_kept(State state) { return state >= State::succeeded && state <= State::aborted; }

}  // namespace

ServedGoals::Goal* ServedGoals::find(const GoalId& id) {
  const auto found = std::ranges::find_if(goals_, [&](const Goal& one) { return one.info.id == id; });
  return found == goals_.end() ? nullptr : &*found;
}

ServedGoals::Goal* ServedGoals::find(std::uint64_t number) {
  const auto found = std::ranges::find(goals_, number, &Goal::number);
  return number == 0 || found == goals_.end() ? nullptr : &*found;
}

void ServedGoals::hear_goal(Question question, const GoalId& id, MessageBytes goal, Stamp at, Instant now) {
  const auto open = std::ranges::count_if(goals_, [](const Goal& one) { return is_open(one.state); });
  const bool repeated = find(id) != nullptr;
  if (repeated || static_cast<std::size_t>(open) >= most_open) {
    ++(repeated ? counts_.repeated : counts_.crowded);
    deeds_.push_back({Deed::Kind::answer_goal, question, goal_answer(false, at)});
    return;
  }
  Goal made;
  made.info = {id, at};
  made.question = question;
  made.message = std::move(goal);
  made.until = now + timeout_;
  goals_.push_back(std::move(made));
}

void ServedGoals::hear_result_question(Question question, const GoalId& id) {
  Goal* const goal = find(id);
  if (goal == nullptr || goal->state == State::none)
    deeds_.push_back({Deed::Kind::answer_result, question, empty_result(State::none)});
  else if (is_kept(goal->state))
    deeds_.push_back({Deed::Kind::answer_result, question, goal->result});
  else
    goal->result_questions.push_back(question);
}

/// The name and the stamp select together: one goal, those up to a time, both, or all.
bool ServedGoals::is_selected(const Goal& goal, const CancelRequest& request) {
  const bool named = request.id != GoalId{};
  const bool timed = request.stamp.sec != 0 || request.stamp.nanosec != 0;
  const bool early =
      goal.info.stamp.sec < request.stamp.sec ||
      (goal.info.stamp.sec == request.stamp.sec && goal.info.stamp.nanosec <= request.stamp.nanosec);
  return (!named && !timed) || (named && goal.info.id == request.id) || (timed && early);
}

void ServedGoals::hear_cancel(Question question, const CancelRequest& request) {
  const Goal* const named = find(request.id);
  std::vector<GoalInfo> canceling;
  bool changed = false;
  for (Goal& goal : goals_) {
    if (!takes_cancels_ || !is_under_way(goal.state) || !is_selected(goal, request)) continue;
    canceling.push_back(goal.info);
    if (goal.state == State::canceling) continue;
    goal.state = State::canceling;
    goal.cancel_is_told = false;
    changed = true;
  }
  auto code = CancelCode::good;
  if (canceling.empty() && request.id != GoalId{})
    code = named == nullptr || named->state == State::none ? CancelCode::unknown_goal
           : is_kept(named->state)                         ? CancelCode::goal_has_ended
                                                           : CancelCode::refused;
  else if (canceling.empty())
    code = CancelCode::refused;
  deeds_.push_back({Deed::Kind::answer_cancel, question, cancel_answer(code, canceling)});
  if (changed) tell_states();
}

void ServedGoals::answer(Goal& goal, bool accepted, Stamp at) {
  goal.info.stamp = at;
  deeds_.push_back({Deed::Kind::answer_goal, goal.question, goal_answer(accepted, at)});
}

/// The goal is forgotten by the next `forget`.
void ServedGoals::reject(Goal& goal, Stamp at) {
  answer(goal, false, at);
  goal.state = State::rejected;
}

void ServedGoals::accept(Goal& goal, Stamp at) {
  answer(goal, true, at);
  goal.state = State::accepted;
  tell_states();
}

void ServedGoals::end(Goal& goal, State state, MessageBytes result, Instant now) {
  goal.state = state;
  goal.result = std::move(result);
  goal.until = now + keeps_results;
  for (const Question question : std::exchange(goal.result_questions, {}))
    deeds_.push_back({Deed::Kind::answer_result, question, goal.result});
  tell_states();
}

void ServedGoals::say(std::uint64_t number, State state, const MessageBytes& feedback,
                      const MessageBytes& result, Stamp at, Instant now) {
  if (number == 0 || state == State::none) return;
  Goal* const goal = find(number);
  if (goal == nullptr) {
    ++counts_.useless;
    return;
  }
  if (!is_open(goal->state)) {
    if (goal->state != state && !(goal->state == State::aborted && state == State::canceled))
      ++counts_.useless;
    return;
  }
  if (goal->state == State::none) {
    if (state == State::rejected) {
      reject(*goal, at);
      return forget(now);
    }
    if (!is_under_way(state) && !is_kept(state)) {
      ++counts_.useless;
      return;
    }
    accept(*goal, at);
  }
  if (goal->state == State::accepted && state >= State::executing && state <= State::aborted) {
    goal->state = State::executing;
    tell_states();
  }
  // A value that accepts with state 1, or ends the goal, has no feedback to tell.
  if (state == State::executing && is_under_way(goal->state) && feedback != goal->feedback) {
    goal->feedback = feedback;
    deeds_.push_back({Deed::Kind::feedback, 0, with_goal_id(goal->info.id, feedback)});
  }
  if (!is_kept(state)) {
    if (!is_under_way(state)) ++counts_.useless;
    return;
  }
  if (state == State::canceled && goal->state != State::canceling) {
    ++counts_.uncancelled;
    MessageBytes aborted = result;
    if (aborted.size() > encapsulation_size)
      aborted[encapsulation_size] = static_cast<std::byte>(State::aborted);
    return end(*goal, State::aborted, std::move(aborted), now);
  }
  end(*goal, state, result, now);
  forget(now);
}

void ServedGoals::refuse(std::uint64_t number, Stamp at) {
  Goal* const goal = find(number);
  if (goal == nullptr || goal->state != State::none) return;
  ++counts_.unfit;
  reject(*goal, at);
}

void ServedGoals::tick(Stamp at, Instant now) {
  for (Goal& goal : goals_)
    if (goal.state == State::none && now >= goal.until) {
      ++counts_.undecided;
      reject(goal, at);
    }
  forget(now);
}

void ServedGoals::end_all(Stamp at, Instant now) {
  for (Goal& goal : goals_) {
    if (goal.state == State::none) reject(goal, at);
    if (is_under_way(goal.state)) end(goal, State::aborted, empty_result(State::aborted), now);
  }
}

void ServedGoals::forget(Instant now) {
  auto ended = static_cast<std::size_t>(
      std::ranges::count_if(goals_, [](const Goal& one) { return is_kept(one.state); }));
  std::erase_if(goals_, [&](const Goal& one) {
    if (one.state == State::rejected) return true;
    if (!is_kept(one.state) || (now < one.until && ended <= most_ended)) return false;
    --ended;
    return true;
  });
}

std::optional<ServedGoals::Event> ServedGoals::take_event() {
  for (Goal& goal : goals_)
    if (goal.number != 0 && !std::exchange(goal.cancel_is_told, true) && is_open(goal.state))
      return Event{goal.number, true, goal.message};
  for (Goal& goal : goals_) {
    if (goal.state != State::none) continue;
    if (goal.number != 0) return std::nullopt;
    goal.number = ++newest_;
    return Event{goal.number, false, goal.message};
  }
  return std::nullopt;
}

std::vector<ServedGoals::Deed> ServedGoals::take_deeds() { return std::exchange(deeds_, {}); }

MessageBytes ServedGoals::empty_result(State state) const {
  MessageBytes result = empty_result_;
  if (result.size() > encapsulation_size) result[encapsulation_size] = static_cast<std::byte>(state);
  return result;
}

void ServedGoals::tell_states() {
  std::vector<GoalStatus> all;
  for (const Goal& goal : goals_)
    if (is_under_way(goal.state) || is_kept(goal.state))
      all.push_back({goal.info, static_cast<std::int8_t>(goal.state)});
  deeds_.push_back({Deed::Kind::status, 0, status_message(all)});
}

}  // namespace tessera::ros2
