#include "ros2/drivers/action_client.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <thread>

#include "ros2/actions/messages.hpp"

namespace tessera::ros2 {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto between_turns = std::chrono::milliseconds(5);
constexpr auto between_looks_for_servers = std::chrono::milliseconds(10);
constexpr std::size_t most_remembered = 64;

/// A kind of loss, and its text.
struct Loss {
  std::uint64_t GoalLife::Counts::*count;
  const char* text;
};
constexpr std::array losses = std::to_array<Loss>(
    {{&GoalLife::Counts::disorder, "a message was dropped: it is out of the order of a goal's life"},
     {&GoalLife::Counts::late_acceptance, "a goal is cancelled: it was accepted after it was given up"},
     {&GoalLife::Counts::repeated, "a goal is cancelled: a server accepts it again after its end"},
     {&GoalLife::Counts::unserved, "a goal was not sent: no server is there"},
     {&GoalLife::Counts::unanswered, "a goal was given up: the server does not answer in time"},
     {&GoalLife::Counts::lost, "a goal was given up: its server has gone, or does not know it any more"},
     {&GoalLife::Counts::uncancelled, "the server refuses to cancel a goal"},
     {&GoalLife::Counts::unreadable, "a goal was given up: its result says no state of an end"}});

}  // namespace

void ActionClient::Sent::add(std::int64_t number, const GoalId& id) {
  all_.emplace_back(number, id);
  if (all_.size() > most_remembered) all_.pop_front();
}

std::optional<GoalId> ActionClient::Sent::find(std::int64_t number) const {
  for (const auto& [known, id] : all_)
    if (known == number) return id;
  return std::nullopt;
}

ActionClient::ActionClient(const ServiceSetup& setup)
    : Shared(setup, std::chrono::seconds(2)), life_([this] { return new_goal_id(prefix_); }) {}

void ActionClient::close() {
  const std::lock_guard lock(mutex_);
  if (!is_last_to_close()) return;
  life_.order(0, /*cancel=*/true, {}, Clock::now());
  const auto until = Clock::now() + longest_goodbye;
  for (progress(); life_.is_busy() && Clock::now() < until; progress())
    std::this_thread::sleep_for(between_turns);
  static_cast<void>(ends_->cancel_goal.await_receipt(longest_goodbye));
  ends_.reset();
  ready_ = 0;
  probes_ = false;
  life_.hear_of_server(false, Clock::now());
}

bool ActionClient::await_server(Duration timeout) {
  const auto until = Clock::now() + timeout;
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      if (ends_ && ends_->servers().ready > 0) return true;
    }
    if (Clock::now() >= until) return false;
    std::this_thread::sleep_for(between_turns);
  }
}

bool ActionClient::order(std::uint64_t call, bool cancel, const std::vector<std::byte>& goal) {
  const std::lock_guard lock(mutex_);
  refused_ = false;
  progress();  // the goal before it may have ended already
  life_.order(call, cancel, goal, Clock::now());
  progress();
  return !refused_;
}

void ActionClient::use_names(const GoalPrefix& prefix) {
  const std::lock_guard lock(mutex_);
  prefix_ = prefix;
}

void ActionClient::keep_events() {
  const std::lock_guard lock(mutex_);
  keeps_events_ = true;
}

std::optional<GoalLife::Event> ActionClient::take_event() {
  const std::lock_guard lock(mutex_);
  progress();
  return life_.take_event();
}

/// Precondition of this and the following: the mutex is locked.
void ActionClient::progress() {
  if (!ends_) return;
  const auto now = Clock::now();
  life_.use({timeout_});
  hear(now);
  look_for_servers(now);
  life_.hear_of_server(ready_ > 0, now);
  act();
  tell_of_losses();
  while (!keeps_events_ && life_.take_event()) continue;
}

void ActionClient::look_for_servers(GoalLife::Instant now) {
  if (now < next_look_) return;
  next_look_ = now + between_looks_for_servers;
  const ServiceEnds::Servers servers = ends_->servers();
  if (servers.foreign && life_.state() == GoalState::ordered)
    warn(foreign_,
         "no goal is sent: somebody who reads goals would misunderstand it. Start all servers with the same "
         "RMW_IMPLEMENTATION, see \"Which ROS 2\" in docs/use/ros2.md");
  ready_ = servers.foreign ? 0 : servers.ready;
}

template <class Hear>
void ActionClient::hear_replies(ServiceEnds& service, const Sent& sent, Hear hear) {
  ServiceEnds::Replies replies = service.take_replies();
  for (; replies.strange > 0; --replies.strange)
    warn(strange_, "a reply without the header of rmw_cyclonedds_cpp was dropped");
  for (ServiceEnds::Reply& one : replies.ours) {
    life_.hear_sign_of_life();
    if (const auto id = sent.find(one.number)) hear(*id, std::move(one.message));
  }
}

void ActionClient::hear(GoalLife::Instant now) {
  hear_replies(ends_->send_goal, goals_, [&](const GoalId& id, MessageBytes message) {
    if (const auto accepted = read_goal_answer(message))
      life_.hear_answer(id, *accepted, now);
    else
      warn(malformed_, "a message was dropped: it is malformed");
  });
  hear_topics(now);
  hear_replies(ends_->cancel_goal, cancels_, [&](const GoalId& id, MessageBytes message) {
    if (const auto code = read_cancel_answer(message))
      life_.hear_of_cancel(id, *code, now);
    else
      warn(malformed_, "a message was dropped: it is malformed");
  });
  hear_replies(ends_->get_result, results_, [&](const GoalId& id, MessageBytes message) {
    const auto status = read_result_status(message);
    life_.hear_result(id, status, std::move(message), now);
  });
  // Whoever has received the question exists.
  if (probes_ && ends_->get_result.await_receipt(Duration::zero())) {
    probes_ = false;
    life_.hear_sign_of_life();
  }
}

void ActionClient::hear_topics(GoalLife::Instant now) {
  for (const auto& message : ActionEnds::messages_of(ends_->status)) {
    const auto goals = read_status(message);
    if (!goals) warn(malformed_, "a message was dropped: it is malformed");
    if (!goals) continue;
    for (const GoalStatus& one : *goals) life_.hear_status(one.info.id, one.status, now);
  }
  for (const auto& message : ActionEnds::messages_of(ends_->feedback)) {
    auto named = split_goal_id(message);
    if (named)
      life_.hear_feedback(named->id, std::move(named->message));
    else
      warn(malformed_, "a message was dropped: it is malformed");
  }
}

void ActionClient::act() {
  using Kind = GoalLife::Deed::Kind;
  for (const GoalLife::Deed& deed : life_.take_deeds()) {
    const bool probe = deed.kind == Kind::probe;
    // A question for a goal that nobody has: a server answers it, and it changes nothing.
    const GoalId id = probe ? new_goal_id({}) : deed.id;
    ServiceEnds& service = deed.kind == Kind::send_goal ? ends_->send_goal
                           : deed.kind == Kind::cancel  ? ends_->cancel_goal
                                                        : ends_->get_result;
    const auto number = service.send_request(deed.kind == Kind::send_goal ? with_goal_id(id, deed.goal)
                                             : deed.kind == Kind::cancel  ? cancel_request({id, {}})
                                                                          : result_request(id));
    if (deed.kind == Kind::send_goal && ready_ > 1) warn(several_, several_servers);
    refused_ = refused_ || (!number && !probe);
    probes_ = probes_ || probe;
    if (!number || probe) continue;
    (deed.kind == Kind::send_goal ? goals_
     : deed.kind == Kind::cancel  ? cancels_
                                  : results_)
        .add(*number, id);
  }
}

void ActionClient::tell_of_losses() {
  for (const Loss& loss : losses)
    while (told_.*loss.count < life_.counts().*loss.count) warn(told_.*loss.count, loss.text);
}

bool ActionClient::cancel_goals_of(const GoalPrefix& prefix, Duration timeout) {
  // A server that has had no goal yet says nothing; one that has just got a goal says so soon.
  constexpr auto says_something_within = std::chrono::milliseconds(700);
  const auto until = Clock::now() + timeout;
  std::optional<Clock::time_point> quiet_until;
  std::map<GoalId, bool> left;  ///< whether its cancel was answered
  for (; Clock::now() < until; std::this_thread::sleep_for(between_turns)) {
    const std::lock_guard lock(mutex_);
    if (!ends_) return false;
    const ServiceEnds::Servers servers = ends_->servers();
    if (servers.foreign || servers.ready == 0 || !ends_->status.has_other_side()) continue;
    if (!quiet_until) quiet_until = Clock::now() + says_something_within;
    for (const auto& message : ActionEnds::messages_of(ends_->status))
      for (const GoalStatus& one : read_status(message).value_or(std::vector<GoalStatus>{})) {
        if (!has_prefix(one.info.id, prefix)) continue;
        if (one.status < static_cast<std::int8_t>(GoalState::accepted) ||
            one.status >= static_cast<std::int8_t>(GoalState::canceling)) {
          left.erase(one.info.id);
        } else if (left.emplace(one.info.id, false).second) {
          if (const auto number = ends_->cancel_goal.send_request(cancel_request({one.info.id, {}})))
            cancels_.add(*number, one.info.id);
        }
      }
    for (const ServiceEnds::Reply& one : ends_->cancel_goal.take_replies().ours) {
      const auto id = cancels_.find(one.number);
      const auto code = read_cancel_answer(one.message);
      if (id && code && *code != CancelCode::refused) left.erase(*id);
    }
    if (left.empty() && Clock::now() >= *quiet_until) return true;
  }
  return false;
}

}  // namespace tessera::ros2
