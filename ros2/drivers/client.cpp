#include "ros2/drivers/client.hpp"

#include <thread>
#include <utility>

namespace tessera::ros2 {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto between_looks = std::chrono::milliseconds(5);
/// The limit for a receptor that is not read.
constexpr std::size_t most_results = 16;

}  // namespace

void ServiceClient::close() {
  const std::lock_guard lock(mutex_);
  if (!is_last_to_close()) return;
  const auto until = Clock::now() + longest_goodbye;
  for (progress(); pending_ && !pending_->sent && Clock::now() < until; progress())
    std::this_thread::sleep_for(between_looks);
  if (pending_ && !pending_->sent) finish(CallOutcome::no_server);
  if (pending_) static_cast<void>(ends_->await_receipt(longest_goodbye));
  pending_.reset();
  ends_.reset();
}

bool ServiceClient::await_server(Duration timeout) {
  const auto until = Clock::now() + timeout;
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      if (ends_ && ends_->servers().ready > 0) return true;
    }
    if (Clock::now() >= until) return false;
    std::this_thread::sleep_for(between_looks);
  }
}

bool ServiceClient::call(std::uint64_t number, std::vector<std::byte> request) {
  const std::lock_guard lock(mutex_);
  refused_ = false;
  if (number != 0 && number != last_) {
    progress();  // the reply to the previous call may be here already
    if (pending_) finish(CallOutcome::replaced);
    last_ = number;
    newest_.reset();
    pending_ = Pending{number, 0, std::move(request), Clock::now() + timeout_};
  }
  progress();
  return !refused_;
}

bool ServiceClient::call_and_wait(std::uint64_t number, const std::vector<std::byte>& request,
                                  Duration timeout) {
  use_timeout(timeout);
  if (!call(number, request)) return false;
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      progress();
      if (newest_ == CallOutcome::answered) return true;
      if (newest_) {
        last_ = 0;  // the same number may be tried again
        return false;
      }
    }
    std::this_thread::sleep_for(between_looks);
  }
}

void ServiceClient::keep_results() {
  const std::lock_guard lock(mutex_);
  keeps_results_ = true;
}

std::optional<ServiceClient::Result> ServiceClient::take_result() {
  const std::lock_guard lock(mutex_);
  progress();
  if (results_.empty()) return std::nullopt;
  Result result = std::move(results_.front());
  results_.pop_front();
  return result;
}

/// Precondition of this and the following: the mutex is locked.
void ServiceClient::progress() {
  if (!ends_) return;
  take_replies();
  if (pending_ && !pending_->sent) try_to_send();
  if (pending_ && Clock::now() >= pending_->until)
    finish(pending_->sent ? CallOutcome::no_reply : CallOutcome::no_server);
}

void ServiceClient::take_replies() {
  ServiceEnds::Replies replies = ends_->take_replies();
  for (; replies.strange > 0; --replies.strange)
    warn(strange_, "a reply without the header of rmw_cyclonedds_cpp was dropped");
  for (ServiceEnds::Reply& one : replies.ours) {
    if (!pending_ || !pending_->sent || pending_->sequence != one.number)
      warn(stray_, "a reply was dropped: its call is over, or was answered already");
    else
      finish(CallOutcome::answered, std::move(one.message));
  }
}

void ServiceClient::try_to_send() {
  const ServiceEnds::Servers servers = ends_->servers();
  if (servers.foreign) {
    if (!std::exchange(pending_->told, true))
      warn(foreign_,
           "no request is sent: somebody who reads requests would misunderstand it. Start all servers with "
           "the "
           "same RMW_IMPLEMENTATION, see \"Which ROS 2\" in docs/use/ros2.md");
    return;
  }
  if (servers.ready == 0) return;
  if (servers.ready > 1) warn(several_, several_servers);
  const auto sequence = ends_->send_request(std::move(pending_->request));
  pending_->sequence = sequence.value_or(0);
  pending_->sent = true;
  refused_ = !sequence;
}

void ServiceClient::finish(CallOutcome outcome, std::vector<std::byte> reply) {
  if (outcome == CallOutcome::no_server) warn(unserved_, "a request was not sent: no server is there");
  if (outcome == CallOutcome::no_reply) warn(unanswered_, "no reply came in time");
  newest_ = outcome;
  if (keeps_results_) results_.push_back(Result{pending_->number, outcome, std::move(reply)});
  if (results_.size() > most_results) {
    results_.pop_front();
    warn(lost_, "a reply was dropped: the receptor is not read");
  }
  pending_.reset();
}

}  // namespace tessera::ros2
