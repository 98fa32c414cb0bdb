#include "ros2/drivers/action_server.hpp"

#include <algorithm>
#include <array>
#include <thread>
#include <utility>

#include "ros2/dds/clock.hpp"

namespace tessera::ros2 {
namespace {

using Clock = std::chrono::steady_clock;

/// Questions without an answer yet: goals, and results of goals that are under way.
constexpr std::size_t most_questions = 1024;
constexpr auto answers_wait = std::chrono::seconds(10);
constexpr auto between_tries = std::chrono::milliseconds(5);

struct Refusal {
  std::uint64_t ServedGoals::Counts::*count;
  const char* text;
};
constexpr std::array refusals = std::to_array<Refusal>(
    {{&ServedGoals::Counts::crowded, "a goal was rejected: too many are open"},
     {&ServedGoals::Counts::undecided, "a goal was rejected: nobody has decided in time"},
     {&ServedGoals::Counts::repeated, "a goal was rejected: another has its name"},
     {&ServedGoals::Counts::useless,
      "a state was dropped: its goal is over, or there was none of that number"},
     {&ServedGoals::Counts::uncancelled,
      "a goal was aborted: it ended as cancelled, which nobody had asked for"},
     {&ServedGoals::Counts::unfit,
      "a goal was rejected: it is none of that type, or does not fit the buffer"}});

}  // namespace

void ActionServer::close() {
  const std::lock_guard lock(mutex_);
  if (!is_last_to_close()) return;
  const auto until = Clock::now() + longest_goodbye;
  progress();
  goals_.end_all(stamp_now(), Clock::now());
  for (progress(); !answers_.empty() && Clock::now() < until; progress())
    std::this_thread::sleep_for(between_tries);
  const auto received_until = Clock::now() + longest_goodbye;  // a client that was killed confirms nothing
  const auto left = [&] { return std::max<Duration>(received_until - Clock::now(), Duration::zero()); };
  for (ServiceEnds* const one : {&ends_->send_goal, &ends_->get_result, &ends_->cancel_goal})
    static_cast<void>(one->await_receipt(left()));
  static_cast<void>(ends_->status.await_receipt(left()));
  answers_.clear();
  asked_.clear();
  ends_.reset();
}

void ActionServer::refuse_cancels() {
  const std::lock_guard lock(mutex_);
  goals_.refuse_cancels();
}

void ActionServer::use_empty_result(MessageBytes result) {
  const std::lock_guard lock(mutex_);
  goals_.use_empty_result(std::move(result));
}

std::optional<ServedGoals::Event> ActionServer::next_event() {
  const std::lock_guard lock(mutex_);
  progress();
  return goals_.take_event();
}

void ActionServer::refuse(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  goals_.refuse(number, stamp_now());
  progress();
}

bool ActionServer::say(std::uint64_t number, GoalState state, const MessageBytes& feedback,
                       const MessageBytes& result) {
  const std::lock_guard lock(mutex_);
  refused_ = false;
  goals_.say(number, state, feedback, result, stamp_now(), Clock::now());
  progress();
  return !refused_;
}

ServiceEnds& ActionServer::service(Part part) {
  return part == Part::goal     ? ends_->send_goal
         : part == Part::result ? ends_->get_result
                                : ends_->cancel_goal;
}

/// Precondition of this and the following: the mutex is locked.
void ActionServer::progress() {
  if (!ends_) return;
  const auto now = Clock::now();
  for (std::size_t others = ends_->send_goal.new_other_servers(); others > 0; --others)
    warn(several_, "another server executes the goals, too, and clients take the first answer");
  goals_.use_timeout(timeout_);
  take_questions(now);
  goals_.tick(stamp_now(), now);
  act(now);
  send_answers(now);
  tell_of_losses();
}

/// take: whether the message is a question of its kind.
template <class Take>
void ActionServer::take_from(Part part, Take take) {
  ServiceEnds::Requests requests = service(part).take_requests();
  for (; requests.foreign > 0; --requests.foreign) warn(foreign_, foreign_request);
  for (ServiceEnds::Request& one : requests.all) {
    if (asked_.size() >= most_questions) {
      warn(crowded_, "a request was dropped: too many wait");
      continue;
    }
    const ServedGoals::Question question = ++newest_;
    asked_.emplace(question, Asked{part, std::move(one.asker)});
    if (take(question, std::move(one.message))) continue;
    asked_.erase(question);
    warn(malformed_, "a request was dropped: it is malformed");
  }
}

void ActionServer::take_questions(Instant now) {
  take_from(Part::goal, [&](ServedGoals::Question question, const MessageBytes& message) {
    auto named = split_goal_id(message);
    if (named) goals_.hear_goal(question, named->id, std::move(named->message), stamp_now(), now);
    return named.has_value();
  });
  take_from(Part::result, [&](ServedGoals::Question question, const MessageBytes& message) {
    const auto id = read_result_request(message);
    if (id) goals_.hear_result_question(question, *id);
    return id.has_value();
  });
  take_from(Part::cancel, [&](ServedGoals::Question question, const MessageBytes& message) {
    const auto request = read_cancel_request(message);
    if (request) goals_.hear_cancel(question, *request);
    return request.has_value();
  });
}

void ActionServer::act(Instant now) {
  using Kind = ServedGoals::Deed::Kind;
  for (ServedGoals::Deed& deed : goals_.take_deeds()) {
    if (deed.kind == Kind::feedback || deed.kind == Kind::status) {
      const bool sent = (deed.kind == Kind::status ? ends_->status : ends_->feedback).write(deed.message);
      refused_ = refused_ || !sent;
    } else if (const auto asked = asked_.find(deed.question); asked != asked_.end()) {
      answers_.push_back({std::move(asked->second), std::move(deed.message), now + answers_wait});
      asked_.erase(asked);
    }
  }
}

/// The writer of answers may not have found a client yet.
void ActionServer::send_answers(Instant now) {
  std::erase_if(answers_, [&](const Answer& one) {
    const ServiceEnds::Sending sending = service(one.to.part).send_reply(one.to.asker, one.message);
    refused_ = refused_ || sending == ServiceEnds::Sending::refused;
    const bool waits = sending == ServiceEnds::Sending::not_yet && now < one.until;
    if (!waits && sending != ServiceEnds::Sending::sent && sending != ServiceEnds::Sending::refused)
      warn(unheard_, "an answer was dropped: its client has gone, or cannot be reached");
    return !waits;
  });
}

void ActionServer::tell_of_losses() {
  for (const Refusal& refusal : refusals)
    while (told_.*refusal.count < goals_.counts().*refusal.count) warn(told_.*refusal.count, refusal.text);
}

}  // namespace tessera::ros2
